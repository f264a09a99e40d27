//! Progress bars on standard error, if it is a terminal.

use super::embedded_session;
use crate::probability::Progress;
use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::sync::{Arc, Mutex};

/// The rate in whole units, such as `1,234/s`; below 10 with one decimal.
fn write_rate(state: &ProgressState, text: &mut dyn std::fmt::Write) {
    let rate = state.per_sec();
    // Writing to the line does not fail.
    let _ = if rate < 10.0 {
        write!(text, "{rate:.1}/s")
    } else {
        write!(text, "{}/s", HumanCount(rate as u64))
    };
}

/// A bar as wide as the terminal leaves room for.
const OF_ONE_STAGE: &str =
    "{msg:12} [{wide_bar}] {percent:>3} % {human_pos}/{human_len} {per_sec} {eta} left";
/// Stages that overlap count different things, so their sum has no rate.
const OF_SEVERAL_STAGES: &str = "{msg:12} [{wide_bar}] {percent:>3} %";

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template)
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("per_sec", write_rate)
        .progress_chars("=> ")
}

/// A bar, and how many stages it shows.
struct SharedBar {
    bar: ProgressBar,
    stages: usize,
}

/// Shows each stage as a progress bar. Stages that overlap share one.
pub(crate) struct ProgressBars {
    quiet: bool,
    bar: Mutex<Option<SharedBar>>,
    /// Of a command that runs inside another program.
    embedded: Option<Arc<dyn Progress + Send>>,
}

impl ProgressBars {
    pub(crate) fn new(quiet: bool) -> Self {
        Self {
            quiet,
            bar: Mutex::new(None),
            embedded: embedded_session::progress(),
        }
    }

    fn new_bar(&self, stage: &str, total: u64) -> ProgressBar {
        let target = if self.quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr_with_hz(8)
        };
        ProgressBar::with_draw_target(Some(total), target)
            .with_style(style(OF_ONE_STAGE))
            .with_message(stage.to_owned())
    }

    fn with(&self, act: impl FnOnce(&mut Option<SharedBar>)) {
        if let Ok(mut bar) = self.bar.lock() {
            act(&mut bar);
        }
    }
}

impl Progress for ProgressBars {
    fn begin(&self, stage: &str, total: u64) {
        if let Some(progress) = &self.embedded {
            return progress.begin(stage, total);
        }
        self.with(|slot| match slot {
            Some(shared) => {
                shared.stages += 1;
                shared.bar.inc_length(total);
                shared.bar.set_style(style(OF_SEVERAL_STAGES));
                shared.bar.set_message(stage.to_owned());
            }
            None => {
                let bar = self.new_bar(stage, total);
                *slot = Some(SharedBar { bar, stages: 1 });
            }
        });
    }

    fn advance(&self, units: u64) {
        if let Some(progress) = &self.embedded {
            return progress.advance(units);
        }
        self.with(|bar| {
            if let Some(shared) = bar {
                shared.bar.inc(units);
            }
        });
    }

    fn end(&self) {
        if let Some(progress) = &self.embedded {
            return progress.end();
        }
        self.with(|slot| {
            let Some(shared) = slot else { return };
            shared.stages -= 1;
            if shared.stages == 0 {
                shared.bar.finish_and_clear();
                *slot = None;
            }
        });
    }
}
