//! Which vector instructions a batch runs on.

use fearless_simd::Level;

/// How many shots a batch steps at once, and on which instructions. Every choice gives the same bits.
#[derive(Clone, Copy, Debug)]
pub struct Lanes(pub(super) Option<Level>);

impl Lanes {
    /// One shot at a time.
    pub const SCALAR: Self = Self(None);

    /// The best this machine has.
    #[must_use]
    pub fn best() -> Self {
        Self(Some(Level::new()))
    }

    /// Everything this machine has, the scalar form first, each with its name.
    #[must_use]
    pub fn available() -> Vec<(&'static str, Self)> {
        let mut found = vec![("scalar", Self::SCALAR)];
        found.push(("baseline", Self(Some(Level::baseline()))));
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
}

impl Default for Lanes {
    fn default() -> Self {
        Self::best()
    }
}
