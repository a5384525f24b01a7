//! How far a long command has come, for whoever sits in front of it.

use indicatif::{ProgressBar, ProgressStyle};

/// A line on stderr that is written over and over; nothing if stderr is no terminal.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// Shows that nothing of `total` is done yet.
    pub fn of(total: usize) -> Progress {
        let bar = ProgressBar::new(total as u64);
        // The template is a constant, and sound: a test draws with it.
        if let Ok(style) = style() {
            bar.set_style(style);
        }
        bar.tick();
        Progress(bar)
    }

    /// The same, and says how long the rest takes at the speed so far.
    pub fn with_time_left(total: usize) -> Progress {
        let Progress(bar) = Progress::of(total);
        if let Ok(style) = style_with_time_left() {
            bar.set_style(style);
        }
        Progress(bar)
    }

    /// One more is done; may be called from any thread.
    pub fn advance(&self) {
        self.0.inc(1);
    }

    /// Leaves an empty line.
    pub fn clear(self) {
        self.0.finish_and_clear();
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
    fn every_step_is_counted_and_the_line_can_be_drawn() {
        style().and_then(|_| style_with_time_left()).expect("sound templates");
        let progress = Progress::of(4);
        (0..3).for_each(|_| progress.advance());
        assert_eq!((progress.0.position(), progress.0.length()), (3, Some(4)));
    }
}
