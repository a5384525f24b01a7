//! Progress of a long command, for the user at the terminal.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::output::print_error;

/// A line on stderr that is rewritten in place; nothing if stderr is not a terminal.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// Shows a progress line with none of `total` steps done.
    pub fn start(total: usize) -> Progress {
        let bar = ProgressBar::new(total as u64);
        // The template is a valid constant: a test draws with it.
        if let Ok(style) = style() {
            bar.set_style(style);
        }
        bar.tick();
        Progress(bar)
    }

    /// Shows a progress line that also estimates the remaining time from the speed so far.
    pub fn with_time_left(total: usize) -> Progress {
        let Progress(bar) = Progress::start(total);
        if let Ok(style) = style_with_time_left() {
            bar.set_style(style);
        }
        Progress(bar)
    }

    /// Counts one more step as done; may be called from any thread.
    pub fn advance(&self) {
        self.0.inc(1);
    }

    pub fn clear(self) {
        self.0.finish_and_clear();
    }
}

/// Progress of a check that takes longer than a second: a line that is written once and, on a terminal, a counter.
pub(crate) struct CheckProgress {
    began: Instant,
    runs: u64,
    checked: AtomicU64,
    bar: OnceLock<ProgressBar>,
}

/// How long a check may take without a word.
const SILENCE: Duration = Duration::from_secs(1);

impl CheckProgress {
    /// Shows a progress line with none of `runs` checked.
    pub fn start(runs: u64) -> CheckProgress {
        CheckProgress { began: Instant::now(), runs, checked: AtomicU64::new(0), bar: OnceLock::new() }
    }

    /// Counts one more run as checked; may be called from any thread.
    pub fn advance(&self) {
        let checked = 1 + self.checked.fetch_add(1, Ordering::Relaxed);
        if self.began.elapsed() < SILENCE || checked == self.runs {
            return;
        }
        let bar = self.bar.get_or_init(|| {
            print_error(&format!("checking {} runs", self.runs));
            let bar = ProgressBar::new(self.runs);
            if let Ok(style) = style_with_time_left() {
                bar.set_style(style);
            }
            bar
        });
        bar.set_position(checked);
    }

    pub fn clear(&self) {
        if let Some(bar) = self.bar.get() {
            bar.finish_and_clear();
        }
    }
}

fn style() -> Result<ProgressStyle, indicatif::style::TemplateError> {
    Ok(ProgressStyle::with_template("[{bar:30}] {pos} of {len} runs")?.progress_chars("##-"))
}

fn style_with_time_left() -> Result<ProgressStyle, indicatif::style::TemplateError> {
    Ok(ProgressStyle::with_template("[{bar:30}] {pos} of {len} runs, {eta} left")?.progress_chars("##-"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_counts_steps_and_its_template_is_valid() {
        style().and_then(|_| style_with_time_left()).expect("sound templates");
        let progress = Progress::start(4);
        (0..3).for_each(|_| progress.advance());
        assert_eq!((progress.0.position(), progress.0.length()), (3, Some(4)));
    }

    #[test]
    fn progress_of_a_check_appears_after_a_second() {
        let quick = CheckProgress::start(3);
        quick.advance();
        assert!(quick.bar.get().is_none());
        let Some(began) = Instant::now().checked_sub(2 * SILENCE) else { return };
        let slow = CheckProgress { began, ..CheckProgress::start(3) };
        slow.advance();
        slow.advance();
        assert_eq!(slow.bar.get().map(ProgressBar::position), Some(2));
        slow.clear();
    }
}
