//! The vector instructions that a batch runs on.

use fearless_simd::Level;
use std::sync::OnceLock;

/// The vector instructions of a batch, and with them the number of lanes. Every choice gives the
/// same bits.
#[derive(Clone, Copy, Debug)]
pub struct InstructionSet(pub(super) Option<Level>);

static DEFAULT: OnceLock<InstructionSet> = OnceLock::new();

impl InstructionSet {
    /// One shot at a time.
    pub const SCALAR: Self = Self(None);

    /// The best that this machine has.
    #[must_use]
    pub fn best() -> Self {
        Self(Some(Level::new()))
    }

    /// All that this machine has with their names, the scalar form first.
    #[must_use]
    pub fn available() -> Vec<(&'static str, Self)> {
        let mut found = vec![
            ("scalar", Self::SCALAR),
            ("baseline", Self(Some(Level::baseline()))),
        ];
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            let level = Level::new();
            if let Some(token) = level.as_avx2() {
                found.push(("avx2", Self(Some(Level::Avx2(token)))));
            }
            if let Some(token) = level.as_avx512() {
                found.push(("avx512", Self(Some(Level::Avx512(token)))));
            }
        }
        found
    }

    /// Makes this the default of simulators that are built later, in place of
    /// [`InstructionSet::best`]. Only the first call counts.
    pub fn use_by_default(self) {
        let _ = DEFAULT.set(self);
    }

    /// The instructions of the lanes; `None` for scalar code. That is also used on x86-64 without
    /// AVX2: SSE2 holds two numbers, and lanes of them would take a third of the time of a build.
    pub(crate) fn level(self) -> Option<Level> {
        #[cfg(target_arch = "x86_64")]
        let level = self.0.filter(|level| level.as_avx2().is_some());
        #[cfg(not(target_arch = "x86_64"))]
        let level = self.0;
        level
    }
}

impl Default for InstructionSet {
    fn default() -> Self {
        DEFAULT.get().copied().unwrap_or_else(Self::best)
    }
}
