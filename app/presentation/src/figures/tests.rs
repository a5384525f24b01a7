//! The registry is complete, every scenario in it exists, every picture is legible, and a failure does not affect other entries.

use std::sync::LazyLock;

use interplay_scenarios::{Override, load};

use super::lookup::EntryDrawing;
use super::*;

/// Figures of each chapter from the first to the last, and tables.
const FIGURES: [(u32, std::ops::RangeInclusive<u32>); 7] =
    [(2, 5..=6), (3, 2..=5), (4, 4..=8), (5, 1..=3), (6, 1..=10), (7, 1..=10), (8, 1..=9)];
const TABLES: [&str; 8] = ["2.1", "3.1", "4.1", "6.1", "6.2", "8.1", "8.2", "8.3"];

#[test]
fn every_figure_and_table_is_in_the_registry_once() {
    let of = |kind: Kind| registry().filter(move |entry| entry.kind == kind).map(|entry| entry.number.to_owned());
    let figures = FIGURES.into_iter().flat_map(|(chapter, figures)| figures.map(move |n| format!("{chapter}.{n}")));
    assert!(of(Kind::Figure).eq(figures), "{:?}", of(Kind::Figure).collect::<Vec<_>>());
    assert!(of(Kind::Table).eq(TABLES.map(str::to_owned)), "{:?}", of(Kind::Table).collect::<Vec<_>>());
}

#[test]
fn every_entry_describes_the_dissertation_and_names_existing_scenarios() {
    for entry in registry() {
        assert!(entry.says.len() > 20 && entry.title.len() > 5, "{entry}");
        for spec in entry.runs.iter().chain(&entry.beside) {
            let sets: Vec<Override> = spec.sets.iter().map(|set| Override::Set(set.clone())).collect();
            if let Err(error) = load(&spec.scenario, &sets) {
                panic!("{entry}: {} with {:?}: {:?}", spec.scenario, spec.sets, error.faults());
            }
        }
    }
}

/// In every picture of every entry all words are legible, and there are marks other than words.
#[test]
fn every_picture_is_legible() {
    let entries: Vec<&'static Entry> = registry().collect();
    let folder = folder("all");
    for made in make(&entries, &folder, &|| ()) {
        let entry = made.entry;
        let content = made.outcome.unwrap_or_else(|error| panic!("{entry}: {error}"));
        assert!(!content.pictures.is_empty(), "{entry} has no picture");
        for picture in &content.pictures {
            assert_eq!(picture.illegible(), Vec::<String>::new(), "{entry}");
            assert!(picture.mark_count() > picture.words().len() + 2, "{entry} has words only");
        }
        for ending in ["svg", "png"] {
            let file = folder.join(format!("{}.{ending}", entry.id()));
            assert!(std::fs::metadata(&file).is_ok_and(|file| file.len() > 1000), "{}", file.display());
        }
        // Tables and parameters of the dissertation need no run; everything else has measures.
        assert!(entry.kind == Kind::Table || !content.tables.is_empty(), "{entry} has nothing measured");
    }
    std::fs::remove_dir_all(folder).expect("it was made above");
}

/// Every axis has a unit, or is a number of something.
#[test]
fn every_axis_has_a_unit() {
    let run = |scenario, set| RunSpec::new("", scenario, &[set]).record().expect("a run");
    let recorded = run("lane-change/front-nice", "duration_s=2");
    let building_layer = run("building/distributed", "iterations=2");
    let plots = [
        driving::motion("", &recorded),
        driving::speeds("", &recorded),
        driving::planner_diagnostics("", &recorded, 0).expect("diagnostics of negotiation"),
        climate::temperatures("", &building_layer, &[0, 1, 2, 3]),
        climate::inputs("", &building_layer, &[0]),
        climate::weather("", &building_layer),
        climate::disturbance("", &building_layer, &[0]),
        climate::costs("", &[&building_layer]),
        climate::rounds("", &building_layer),
    ];
    for plot in plots {
        let unit = |words: &str| words.ends_with(']') || words.contains("iteration") || words.contains("round");
        assert!(unit(&plot.across), "{}", plot.across);
        assert!(!plot.panels.is_empty());
        for panel in plot.panels {
            assert!(unit(&panel.name), "{}", panel.name);
            assert!(panel.curves.iter().all(|curve| curve.points.len() > 1), "{}", panel.name);
        }
    }
}

/// An entry whose drawing needs a run, without runs.
static WITHOUT_RUN: LazyLock<Entry> = LazyLock::new(|| Entry {
    kind: Kind::Figure,
    number: "0.1".to_owned(),
    title: "A figure that cannot be drawn".to_owned(),
    says: String::new(),
    erratum: None,
    runs: Vec::new(),
    beside: Vec::new(),
    drawing: EntryDrawing::Speeds,
});
static UNKNOWN_SCENARIO: LazyLock<Entry> = LazyLock::new(|| Entry {
    number: "0.2".to_owned(),
    runs: vec![RunSpec::new("", "no/such-scenario", &[])],
    ..WITHOUT_RUN.clone()
});

#[test]
fn a_figure_that_fails_does_not_stop_the_others() {
    let sound = registry().find(|entry| entry.number == "8.1").expect("it is there");
    let steps = std::sync::atomic::AtomicUsize::new(0);
    let advance = || {
        steps.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    let entries = [&*WITHOUT_RUN, &*UNKNOWN_SCENARIO, sound];
    let folder = folder("failing");
    let made = make(&entries, &folder, &advance);
    std::fs::remove_dir_all(folder).expect("it was made above");
    let outcomes: Vec<Result<(), String>> =
        made.iter().map(|made| made.outcome.as_ref().map(|_| ()).map_err(ToString::to_string)).collect();
    assert_eq!(outcomes[0], Err("Fig. 0.1: the run was not made".to_owned()));
    assert!(outcomes[1].as_ref().is_err_and(|error| error.contains("no/such-scenario")), "{outcomes:?}");
    assert_eq!(outcomes[2], Ok(()));
    assert_eq!(steps.into_inner(), super::steps(&entries));
    let parts: Vec<crate::page::SectionStatus> = made.iter().map(|made| section(made).verdict).collect();
    assert_eq!(parts[0], crate::page::SectionStatus::Broken("Fig. 0.1: the run was not made".to_owned()));
    assert_eq!(parts[2], crate::page::SectionStatus::Shown);
}

/// An empty folder of this test.
fn folder(name: &str) -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!("interplay-figures-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}
