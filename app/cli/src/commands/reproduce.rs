//! `interplay reproduce`

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use interplay_presentation::figures::{self, Entry, EntryOutcome, Kind, find, make, registry, section};
use interplay_presentation::page::Page;

use crate::output::error::ExitStatus;
use crate::output::progress::Progress;
use crate::output::{print_error, printed};

/// Make the figures and tables of the dissertation again, as SVG and PNG, with a page that shows and explains them.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay reproduce                          (all of them, into figures/)\n  \
    interplay reproduce 6.1 table-8.2 --out mine\n  \
    interplay reproduce 5                        (all of chapter 5)")]
pub(crate) struct Reproduce {
    /// Figures (6.1), tables (table-6.1), or chapters (6) [default: all]
    #[arg(value_name = "FIGURE")]
    figures: Vec<String>,

    /// Where the pictures and index.html go
    #[arg(long, value_name = "DIR", default_value = "figures")]
    out: PathBuf,

    /// List what there is, and make nothing
    #[arg(long)]
    list: bool,
}

impl Reproduce {
    pub(crate) fn execute(self) -> ExitStatus {
        if self.list {
            return printed(
                &registry().map(|entry| format!("{:10}  {}\n", entry.id(), entry.title)).collect::<String>(),
            );
        }
        let entries = match find(&self.figures) {
            Ok(entries) => entries,
            Err(error) => {
                print_error(&format!("Error: {error}"));
                return ExitStatus::BadInput;
            }
        };
        if let Err(error) = std::fs::create_dir_all(&self.out) {
            print_error(&format!(
                "Error: cannot make the folder {}: {error}; name another with --out",
                self.out.display()
            ));
            return ExitStatus::Unfinished;
        }
        let page = self.out.join("index.html");
        if Page::is_taken(&page) {
            print_error(&format!(
                "`{}` is not a page that Interplay wrote; choose another folder for --out",
                page.display()
            ));
            return ExitStatus::BadInput;
        }
        let began = Instant::now();
        let progress = Progress::start(figures::steps(&entries));
        let made = make(&entries, &self.out, &|| progress.advance());
        progress.clear();
        if let Err(error) = interplay_files::write(&page, page_of(&made).html().as_bytes()) {
            print_error(&format!("Error: cannot write {}: {error}", page.display()));
            return ExitStatus::Unfinished;
        }
        ending(&made).max(print_outcomes(&made, &page, began.elapsed().as_secs_f64()))
    }
}

fn page_of(made: &[EntryOutcome]) -> Page {
    let count = |kind: Kind| made.iter().filter(|made| made.entry.kind == kind).count();
    let broken = made.iter().filter(|made| made.outcome.is_err()).count();
    let missed = made.iter().filter(|made| made.outcome.is_ok() && !made.held()).count();
    let tally = format!(
        "{} figures and {} tables; {broken} could not be made, and in {missed} an expectation of a scenario failed.",
        count(Kind::Figure),
        count(Kind::Table)
    );
    Page {
        title: "The figures and tables of the dissertation, made again".to_owned(),
        opening: vec![
            "C. Peng, Optimization Based Control for Multi-agent System with Interaction, Berkeley 2019. Nothing here is \
             copied from it: every picture is drawn from runs of this program, and every table below a picture is \
             measured from the same runs."
                .to_owned(),
            tally,
        ],
        sections: made.iter().map(section).collect(),
    }
}

fn print_outcomes(made: &[EntryOutcome], page: &Path, wall_s: f64) -> ExitStatus {
    for made in made {
        let entry: &Entry = made.entry;
        match &made.outcome {
            Err(error) => print_error(&format!("{entry} could not be made: {error}")),
            Ok(_) if !made.held() => print_error(&format!("{entry}: an expectation of its scenario failed")),
            Ok(_) => {}
        }
    }
    let done = made.iter().filter(|made| made.outcome.is_ok()).count();
    printed(&format!("{done} of {} made in {wall_s:.1} s: {}\n", made.len(), page.display()))
}

/// A figure that could not be made weighs more than an expectation that failed.
fn ending(made: &[EntryOutcome]) -> ExitStatus {
    if made.iter().any(|made| made.outcome.is_err()) {
        ExitStatus::Unfinished
    } else if made.iter().any(|made| !made.held()) {
        ExitStatus::Failed
    } else {
        ExitStatus::Well
    }
}
