//! Waiting for the device: for as long as someone is ready to, and without falling over where a driver loses it.

use crate::{Gpu, GpuError, error::one_line};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// How long to wait for what should take fractions of a second, before the device counts as hung.
pub const PATIENCE: Duration = Duration::from_secs(60);

impl Gpu {
    /// Waits until everything that was submitted up to `until` is done, or everything there is; at most `patience`.
    /// Returns whether it is. `what` names the work in errors.
    ///
    /// # Errors
    /// [`GpuError::Lost`] if the device fails.
    pub fn wait(
        &self,
        what: &str,
        until: Option<&wgpu::SubmissionIndex>,
        patience: Duration,
    ) -> Result<bool, GpuError> {
        let begun = Instant::now();
        loop {
            let left = patience.saturating_sub(begun.elapsed());
            // an interface may give up sooner than it is asked to: OpenGL after two seconds
            let wait = wgpu::PollType::Wait { submission_index: until.cloned(), timeout: Some(left) };
            match self.poll(wait) {
                Ok(_) => break,
                Err(Fault::TimeIsUp) if left.is_zero() => return Ok(false),
                Err(Fault::TimeIsUp) => {}
                Err(Fault::Lost(why)) => return Err(self.lost(what, why)),
            }
        }
        self.sound(what).map(|()| true)
    }

    /// As [`Gpu::wait`] for everything there is; a device that takes longer than [`PATIENCE`] has failed.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn wait_for_all(&self, what: &str) -> Result<(), GpuError> {
        if self.wait(what, None, PATIENCE)? {
            return Ok(());
        }
        Err(self.lost(what, format!("there was no answer in {} seconds", PATIENCE.as_secs())))
    }

    /// Lets the device tell what it has done, without waiting.
    ///
    /// # Errors
    /// [`GpuError::Lost`] if the device fails.
    pub fn look(&self, what: &str) -> Result<(), GpuError> {
        match self.poll(wgpu::PollType::Poll) {
            Err(Fault::Lost(why)) => Err(self.lost(what, why)),
            Ok(_) | Err(Fault::TimeIsUp) => self.sound(what),
        }
    }

    /// That nothing has gone wrong so far.
    fn sound(&self, what: &str) -> Result<(), GpuError> {
        self.fault().map_or(Ok(()), |why| Err(GpuError::Lost { what: what.to_owned(), why }))
    }

    /// What did not come back, and why: the first fault if one is known.
    pub fn lost(&self, what: &str, why: String) -> GpuError {
        GpuError::Lost { what: what.to_owned(), why: self.fault().unwrap_or(why) }
    }

    fn poll(&self, wait: wgpu::PollType) -> Result<wgpu::PollStatus, Fault> {
        // wgpu 30 panics here if a driver loses the device or runs out of memory
        match caught(|| self.device.poll(wait)) {
            Ok(Ok(status)) => Ok(status),
            Ok(Err(wgpu::PollError::Timeout)) => Err(Fault::TimeIsUp),
            Ok(Err(why)) => Err(Fault::Lost(one_line(&why))),
            Err(why) => {
                self.remember(why.clone());
                Err(Fault::Lost(why))
            }
        }
    }
}

/// What `work` returns, or what it said when it panicked.
fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    let lost = |panic: Box<dyn Any + Send>| format!("the graphics device was lost: {}", words_of(panic.as_ref()));
    catch_unwind(AssertUnwindSafe(work)).map_err(lost)
}

enum Fault {
    TimeIsUp,
    Lost(String),
}

/// What a panic said.
fn words_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or(panic.downcast_ref::<String>().map(String::as_str));
    one_line(&text.unwrap_or("its driver does not say why"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_told_in_one_line() {
        let told = Err("the graphics device was lost: no answer".to_owned());
        assert_eq!(caught(|| panic!("no\n  answer")), told.clone());
        assert_eq!(caught(|| panic!("no {}", "answer")), told);
        assert_eq!(caught(|| 3), Ok(3));
    }

    #[test]
    fn a_device_without_work_is_done_and_one_that_failed_says_so_to_all_who_wait() {
        let gpu = Gpu::headless().unwrap();
        assert!(gpu.wait("nothing", None, PATIENCE).unwrap());
        gpu.look("nothing").unwrap();
        gpu.remember("it has failed".into());
        let told = gpu.wait_for_all("a picture").unwrap_err().to_string();
        assert_eq!(told, "a picture did not come back from the graphics device: it has failed");
        assert!(gpu.look("a picture").is_err());
    }
}
