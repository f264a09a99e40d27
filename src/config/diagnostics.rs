//! What is wrong with a configuration file: all of it at once, each with its line.

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::ops::Range;

/// One error in a configuration file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Where, in bytes of the text. If a key is missing, its table.
    pub span: Range<usize>,
    /// The key, such as `shooter.errors.c10`; empty for an error of the syntax.
    pub key: String,
    /// What is wrong and what is allowed.
    pub message: String,
}

/// All errors in a configuration file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigError {
    /// Name of the file, for messages.
    pub origin: String,
    /// Its text.
    pub text: String,
    /// The errors in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

impl std::error::Error for ConfigError {}

impl std::fmt::Display for ConfigError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let renderer = Renderer::plain();
        for (i, diagnostic) in self.diagnostics.iter().enumerate() {
            let title = if diagnostic.key.is_empty() {
                diagnostic.message.clone()
            } else {
                format!("{}: {}", diagnostic.key, diagnostic.message)
            };
            let end = diagnostic.span.end.min(self.text.len());
            let start = diagnostic.span.start.min(end);
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
