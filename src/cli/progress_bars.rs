//! Progress on standard error: bars on a terminal, now and then a line elsewhere.

use super::embedded_session;
use super::terminal::{is_quiet, print_remark};
use crate::probability::Progress;
use indicatif::{
    HumanCount, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle,
};
use std::io::IsTerminal;
use std::sync::{Arc, LazyLock, Mutex};
use std::time::{Duration, Instant};

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
    began: Instant,
}

/// When the next line of progress is due in a log. The pauses grow with the time that has passed,
/// so that a night's log stays short.
struct LogLines {
    began: Instant,
    due: Instant,
    /// From then on a line is overdue.
    late: Instant,
}

impl LogLines {
    const SHORTEST_PAUSE: Duration = Duration::from_secs(5);
    const LONGEST_PAUSE: Duration = Duration::from_secs(600);
    /// A younger stage has no line, unless the log has had none for [`Self::LONGEST_SILENCE`].
    const LEAST_STAGE: Duration = Duration::from_secs(2);
    const LONGEST_SILENCE: Duration = Duration::from_secs(8);
    /// A pause is the time that has passed divided by this.
    const PART: u32 = 6;

    fn new() -> Self {
        let began = Instant::now();
        Self {
            began,
            due: began + Self::SHORTEST_PAUSE,
            late: began + Self::LONGEST_SILENCE,
        }
    }

    /// After a line: when the next one is due.
    fn wait(&mut self, now: Instant) {
        let pause = (now - self.began) / Self::PART;
        self.due = now + pause.clamp(Self::SHORTEST_PAUSE, Self::LONGEST_PAUSE);
        self.late = self.due + (Self::LONGEST_SILENCE - Self::SHORTEST_PAUSE);
    }
}

/// One for the whole program: each command has several [`ProgressBars`] in turn.
static LOG: LazyLock<Mutex<LogLines>> = LazyLock::new(|| Mutex::new(LogLines::new()));

/// The time of a command begins.
pub(super) fn begin_log() {
    if let Ok(mut log) = LOG.lock() {
        *log = LogLines::new();
    }
}

/// How far a bar is, as a line of a log, such as `finding shots: 12 of 40, about 35 seconds left of
/// this step`.
fn log_line(shared: &SharedBar, now: Instant, is_late: bool) -> Option<String> {
    let stage = shared.bar.message();
    let (done, total) = (shared.bar.position(), shared.bar.length()?);
    // A stage that has just begun tells little yet, and one that ends nothing more.
    let is_young = now - shared.began < LogLines::LEAST_STAGE;
    if (is_young && !is_late) || done >= total {
        return None;
    }
    let share = done as f64 / total.max(1) as f64;
    // Stages that overlap count different things.
    if shared.stages > 1 || done == 0 || is_young {
        return Some(format!("{stage}: {:.0} %", 100.0 * share));
    }
    let left_s = (now - shared.began).as_secs_f64() * (1.0 / share - 1.0);
    let left = HumanDuration(Duration::try_from_secs_f64(left_s).ok()?);
    Some(format!(
        "{stage}: {} of {}, about {left} left of this step",
        HumanCount(done),
        HumanCount(total)
    ))
}

/// Shows each stage as a progress bar. Stages that overlap share one.
pub(crate) struct ProgressBars {
    is_shown: bool,
    bar: Mutex<Option<SharedBar>>,
    /// Where standard error is a file or a pipe.
    is_log: bool,
    /// Of a command that runs inside another program.
    embedded: Option<Arc<dyn Progress + Send>>,
}

impl ProgressBars {
    /// Bars, unless the user wants none.
    pub(crate) fn new() -> Self {
        Self::shown(!is_quiet())
    }

    /// No bars: what they say stands elsewhere.
    pub(crate) fn hidden() -> Self {
        Self::shown(false)
    }

    fn shown(is_shown: bool) -> Self {
        Self {
            is_shown,
            bar: Mutex::new(None),
            is_log: is_shown && !std::io::stderr().is_terminal(),
            embedded: embedded_session::progress(),
        }
    }

    fn new_bar(&self, stage: &str, total: u64) -> ProgressBar {
        let target = if self.is_shown {
            ProgressDrawTarget::stderr_with_hz(8)
        } else {
            ProgressDrawTarget::hidden()
        };
        ProgressBar::with_draw_target(Some(total), target)
            .with_style(style(OF_ONE_STAGE))
            .with_message(stage.to_owned())
    }

    fn log_progress(&self, shared: &SharedBar) {
        if !self.is_log {
            return;
        }
        let now = Instant::now();
        if let Ok(mut log) = LOG.lock()
            && now >= log.due
            && let Some(line) = log_line(shared, now, now >= log.late)
        {
            log.wait(now);
            print_remark(&line);
        }
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
                *slot = Some(SharedBar {
                    bar,
                    stages: 1,
                    began: Instant::now(),
                });
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
                self.log_progress(shared);
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
