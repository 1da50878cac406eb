//! A stack whose places cost nothing until they are used.

use std::mem::MaybeUninit;

/// At most `N` values. Walks of a hierarchy need one for every ray: to fill a kilobyte with zeros would
/// take as long as a node.
pub struct Stack<T: Copy, const N: usize> {
    height: usize,
    places: [MaybeUninit<T>; N],
}

impl<T: Copy, const N: usize> Default for Stack<T, N> {
    #[inline(always)]
    fn default() -> Self {
        Stack { height: 0, places: [const { MaybeUninit::uninit() }; N] }
    }
}

impl<T: Copy, const N: usize> Stack<T, N> {
    /// Puts a value on top. Panics if there are `N` already.
    #[inline(always)]
    pub fn push(&mut self, value: T) {
        self.places[self.height] = MaybeUninit::new(value);
        self.height += 1;
    }

    /// Takes the topmost value.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        self.height = self.height.checked_sub(1)?;
        // SAFETY: `push` wrote all places below the height, and the height is at most `N`
        Some(unsafe { self.places.get_unchecked(self.height).assume_init() })
    }
}
