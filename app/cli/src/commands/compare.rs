//! `interplay compare`

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use interplay_presentation::page::Page;
use interplay_presentation::report::{self, ShownFigures};
use interplay_scenarios::Registry;
use interplay_sweep::compare::{GroupBy, compare, compare_versions};

use crate::output::error::{CommandError, ExitStatus, write_file};
use crate::output::{ending, gave_up, json, print, print_error};

/// Say what the rows of a sweep tell of the planners, or what two sweeps of one plan do differently.
#[derive(Debug, Args)]
#[command(
    after_help = "Shares come with Wilson's intervals, means with bootstrapped ones; differences are those of pairs of runs \
    under the same conditions, tested exactly and corrected for how many tests there are.\n\n\
    Examples:\n  \
    interplay compare sweeps/quick\n  \
    interplay compare results --baseline idm --by scenario --json\n  \
    interplay compare results-of-old-version results-of-new-version"
)]
pub(crate) struct Compare {
    /// The folder of a sweep, or a file of its rows
    #[arg(value_name = "DIR|FILE")]
    first: PathBuf,

    /// Another one of the same plan, made by another version of the program
    #[arg(value_name = "OTHER", conflicts_with_all = ["baseline", "by"])]
    second: Option<PathBuf>,

    /// The planner that the others are compared with [default: the first of the plan]
    #[arg(long, value_name = "PLANNER")]
    baseline: Option<String>,

    /// What the rows are grouped by, besides the style
    #[arg(long, value_name = "WHAT", value_enum, default_value_t = By::Family)]
    by: By,

    /// Show all figures, and not only success, which vehicle goes first, time and contacts at fault
    #[arg(long)]
    all: bool,

    /// Where the page goes [default: comparison.html in the folder; with OTHER or --json, nowhere]
    #[arg(long, value_name = "FILE.html")]
    page: Option<PathBuf>,

    /// Print the figures as one JSON document
    #[arg(long)]
    json: bool,
}

/// What rows are grouped by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum By {
    /// The family of the scenario
    Family,
    /// The scenario itself
    Scenario,
}

impl Compare {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        if let Some(page) = self.page_path().filter(|page| Page::is_taken(page)) {
            print_error(&format!(
                "`{}` is not a page that Interplay wrote; choose another name for --page",
                page.display()
            ));
            return ExitStatus::BadInput;
        }
        let shown = if self.all { ShownFigures::All } else { ShownFigures::First };
        let by = if self.by == By::Family { GroupBy::Family } else { GroupBy::Scenario };
        match &self.second {
            None => match compare(&self.first, self.baseline.as_deref(), by, registry.metrics()) {
                Ok(figures) => {
                    let page = |title: &str| report::comparison_page(title, &figures).map_err(CommandError::from);
                    self.show(|| json("the figures", &figures), || report::comparison(&figures, shown), page)
                }
                Err(error) => gave_up(error),
            },
            Some(second) => match compare_versions(&self.first, second, registry.metrics()) {
                Ok(figures) => {
                    let page = |title: &str| Ok(report::version_comparison_page(title, &figures));
                    let text = || report::version_comparison(&figures);
                    self.show(|| json("the figures", &figures), text, page)
                }
                Err(error) => gave_up(error),
            },
        }
    }

    /// Where the page goes, if anywhere.
    fn page_path(&self) -> Option<PathBuf> {
        let has_place = !self.json && self.second.is_none() && self.first.is_dir();
        self.page.clone().or_else(|| has_place.then(|| self.first.join("comparison.html")))
    }

    /// Prints the figures and writes their page.
    fn show(
        &self,
        as_json: impl Fn() -> Result<String, CommandError>,
        text: impl Fn() -> String,
        page: impl Fn(&str) -> Result<Page, CommandError>,
    ) -> ExitStatus {
        let shown = if self.json { as_json() } else { Ok(text()) };
        let shown = shown.and_then(|text| {
            print(&text)?;
            let Some(target) = self.page_path() else { return Ok(()) };
            let title = match &self.second {
                None => format!("Comparison of {}", self.first.display()),
                Some(second) => format!("Comparison of {} and {}", self.first.display(), second.display()),
            };
            write(&target, &page(&title)?)
        });
        ending(shown)
    }
}

/// Writes a page atomically.
fn write(target: &Path, page: &Page) -> Result<(), CommandError> {
    write_file(target, page.html().as_bytes())?;
    print_error(&format!("page in {}", target.display()));
    Ok(())
}

/// Compares the rows of a folder and writes their page, as a sweep does at its end.
pub(crate) fn after_sweep(folder: &Path, registry: &Registry) -> ExitStatus {
    let compare = Compare {
        first: folder.to_owned(),
        second: None,
        baseline: None,
        by: By::Family,
        all: false,
        page: None,
        json: false,
    };
    compare.execute(registry)
}
