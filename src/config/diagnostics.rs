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
    /// Its sort, for what is said beside it.
    pub(super) problem: Problem,
}

/// The sort of a [`Diagnostic`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Problem {
    /// The key is not given.
    Missing,
    /// The value is not written as a quantity of this dimension is.
    Writing,
    /// Another one.
    #[default]
    Other,
}

impl Diagnostic {
    /// The diagnostic as one of a kind.
    pub(super) fn of(mut self, problem: Problem) -> Self {
        self.problem = problem;
        self
    }
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

/// Errors that are shown; the others are counted.
const MAX_SHOWN: usize = 50;
/// Longest line that is quoted, bytes.
const LONGEST_QUOTE: usize = 1000;

impl ConfigError {
    /// One error as text: what is wrong, and the line where. Only that line is given to the
    /// renderer, since it walks through all of its text.
    fn render(&self, renderer: &Renderer, diagnostic: &Diagnostic) -> String {
        let title = if diagnostic.key.is_empty() {
            diagnostic.message.clone()
        } else {
            format!("{}: {}", diagnostic.key, diagnostic.message)
        };
        let (start, end) = self.boundaries(&diagnostic.span);
        let line_start = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = self.text[start..]
            .find('\n')
            .map_or(self.text.len(), |at| start + at);
        let before = &self.text.as_bytes()[..line_start];
        let line_number = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        if line_end - line_start > LONGEST_QUOTE {
            let column = 1 + self.text[line_start..start].chars().count();
            return format!(
                "error: {title}\n --> {}:{line_number}:{column}",
                self.origin
            );
        }
        let span = start - line_start..end.min(line_end) - line_start;
        let group = Level::ERROR.primary_title(&title).element(
            Snippet::source(&self.text[line_start..line_end])
                .line_start(line_number)
                .path(&self.origin)
                .annotation(AnnotationKind::Primary.span(span)),
        );
        renderer.render(&[group])
    }

    /// Line and column of each diagnostic in the text, from 1. One walk through the text finds all:
    /// they are in its order.
    #[must_use]
    pub fn lines_and_columns(&self) -> Vec<(usize, usize)> {
        let (mut at, mut line, mut column) = (0, 1, 1);
        let mut place = |diagnostic: &Diagnostic| {
            let start = self.boundaries(&diagnostic.span).0.max(at);
            for letter in self.text[at..start].chars() {
                (line, column) = match letter {
                    '\n' => (line + 1, 1),
                    _ => (line, column + 1),
                };
            }
            at = start;
            (line, column)
        };
        self.diagnostics.iter().map(&mut place).collect()
    }

    /// The start and the end of a span, moved to boundaries of characters of the text.
    fn boundaries(&self, span: &Range<usize>) -> (usize, usize) {
        let boundary = |at: usize| {
            let mut at = at.min(self.text.len());
            while !self.text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let end = boundary(span.end);
        (boundary(span.start.min(end)), end)
    }
}

impl std::fmt::Display for ConfigError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let renderer = Renderer::plain();
        for (i, diagnostic) in self.diagnostics.iter().take(MAX_SHOWN).enumerate() {
            let gap = if i == 0 { "" } else { "\n" };
            write!(f, "{gap}{}", self.render(&renderer, diagnostic))?;
        }
        match self.diagnostics.len().saturating_sub(MAX_SHOWN) {
            0 => Ok(()),
            more => write!(f, "\n... and {more} more errors in {}", self.origin),
        }
    }
}
