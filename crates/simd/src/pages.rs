//! Large pages.

/// Asks the system to back memory by large pages where it lends them only to those who ask (Linux: `madvise`): of the
/// tens of megabytes of a large scene's hierarchy a ray touches a few lines here and there, and each page of 4 KiB that
/// it has not touched lately costs a walk through the page table. To be asked before the memory is first written to. A
/// wish: nothing happens where it is not granted.
pub fn ask_for_large_pages(memory: &mut [f32]) {
    #[cfg(target_os = "linux")]
    {
        const PAGE: usize = 4096;
        const MADV_HUGEPAGE: i32 = 14;
        unsafe extern "C" {
            fn madvise(address: *mut std::ffi::c_void, length: usize, advice: i32) -> i32;
        }
        let whole = memory.as_mut_ptr_range();
        let first = whole.start.addr().next_multiple_of(PAGE);
        let length = (whole.end.addr() & !(PAGE - 1)).saturating_sub(first);
        if length > 0 {
            let start = whole.start.wrapping_byte_add(first - whole.start.addr());
            // SAFETY: the pages lie within `memory`; the advice changes no content
            unsafe { madvise(start.cast(), length, MADV_HUGEPAGE) };
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = memory;
}
