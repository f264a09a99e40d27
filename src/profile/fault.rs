//! What is wrong with a profile, told all at once, each fault at its line.

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::ops::Range;

/// One thing wrong with a profile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where, in bytes of the text; empty at the end of the table in which something is missing.
    pub span: Range<usize>,
    /// The key, such as `shooter.errors.c10`.
    pub key: String,
    /// What is wrong and what is allowed.
    pub message: String,
}

/// Everything wrong with a profile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProfileError {
    /// Name of the file, for messages.
    pub origin: String,
    /// The text, where it could be read.
    pub text: String,
    /// The faults, in the order of the text.
    pub faults: Vec<Fault>,
}

impl std::error::Error for ProfileError {}

impl std::fmt::Display for ProfileError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let renderer = Renderer::plain();
        for (i, fault) in self.faults.iter().enumerate() {
            let title = if fault.key.is_empty() {
                fault.message.clone()
            } else {
                format!("{}: {}", fault.key, fault.message)
            };
            let end = fault.span.end.min(self.text.len());
            let start = fault.span.start.min(end);
            let group = Level::ERROR.primary_title(&title).element(
                Snippet::source(&self.text)
                    .path(&self.origin)
                    .annotation(AnnotationKind::Primary.span(start..end)),
            );
            let gap = if i == 0 { "" } else { "\n" };
            write!(f, "{gap}{}", renderer.render(&[group]))?;
        }
        Ok(())
    }
}
