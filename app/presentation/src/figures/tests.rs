//! The registry is complete, every scenario that it runs exists, every picture can be read, and a failure stays alone.

use interplay_scenarios::{Override, load};

use super::*;

/// Figures of each chapter from the first to the last, and tables.
const FIGURES: [(u32, std::ops::RangeInclusive<u32>); 7] =
    [(2, 5..=6), (3, 2..=5), (4, 4..=8), (5, 1..=3), (6, 1..=10), (7, 1..=10), (8, 1..=9)];
const TABLES: [&str; 8] = ["2.1", "3.1", "4.1", "6.1", "6.2", "8.1", "8.2", "8.3"];

#[test]
fn every_figure_and_table_is_there_once() {
    let of = |kind: Kind| registry().filter(move |entry| entry.kind == kind).map(|entry| entry.number.to_owned());
    let figures = FIGURES.into_iter().flat_map(|(chapter, figures)| figures.map(move |n| format!("{chapter}.{n}")));
    assert!(of(Kind::Figure).eq(figures), "{:?}", of(Kind::Figure).collect::<Vec<_>>());
    assert!(of(Kind::Table).eq(TABLES.map(str::to_owned)), "{:?}", of(Kind::Table).collect::<Vec<_>>());
}

#[test]
fn every_entry_says_what_the_source_shows_and_names_scenarios_that_exist() {
    for entry in registry() {
        assert!(entry.says.len() > 20 && entry.title.len() > 5, "{entry}");
        for spec in entry.runs.iter().chain(entry.beside) {
            let sets: Vec<Override> = spec.sets.iter().map(|set| Override::Set((*set).to_owned())).collect();
            if let Err(error) = load(spec.scenario, &sets) {
                panic!("{entry}: {} with {:?}: {:?}", spec.scenario, spec.sets, error.faults());
            }
        }
    }
}

/// In every picture of every entry all words can be read, and there is something to see besides.
#[test]
fn every_picture_can_be_read() {
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
        // The source's own tables and parameters need no run; all else is measured.
        assert!(entry.kind == Kind::Table || !content.tables.is_empty(), "{entry} has nothing measured");
    }
    std::fs::remove_dir_all(folder).expect("it was made above");
}

/// Every axis has a unit, or is a number of something.
#[test]
fn every_axis_has_a_unit() {
    let recorded =
        RunSpec { label: "", scenario: "lane-change/front-nice", sets: &["duration_s=2"] }.record().expect("a run");
    let building_layer =
        RunSpec { label: "", scenario: "building/distributed", sets: &["iterations=2"] }.record().expect("a run");
    let plots = [
        driving::motion("", &recorded),
        driving::speeds("", &recorded),
        driving::reasons("", &recorded, 0).expect("negotiation says what it thinks"),
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

static BROKEN: Entry = Entry {
    kind: Kind::Figure,
    number: "0.1",
    title: "What cannot be drawn",
    says: "",
    erratum: None,
    runs: &[],
    beside: &[],
    draw: |_, _| Err(FigureError::NotRun("nothing")),
};
static MISSING: Entry = Entry {
    number: "0.2",
    runs: &[RunSpec { label: "", scenario: "no/such-scenario", sets: &[] }],
    draw: |_, _| Ok(FigureContent::default()),
    ..BROKEN
};

#[test]
fn a_figure_that_fails_does_not_stop_the_others() {
    let whole = registry().find(|entry| entry.number == "8.1").expect("it is there");
    let steps = std::sync::atomic::AtomicUsize::new(0);
    let advance = || {
        steps.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    let entries = [&BROKEN, &MISSING, whole];
    let folder = folder("failing");
    let made = make(&entries, &folder, &advance);
    std::fs::remove_dir_all(folder).expect("it was made above");
    let outcomes: Vec<Result<(), String>> =
        made.iter().map(|made| made.outcome.as_ref().map(|_| ()).map_err(ToString::to_string)).collect();
    assert_eq!(outcomes[0], Err("nothing was not run".to_owned()));
    assert!(outcomes[1].as_ref().is_err_and(|error| error.contains("no/such-scenario")), "{outcomes:?}");
    assert_eq!(outcomes[2], Ok(()));
    assert_eq!(steps.into_inner(), super::steps(&entries));
    let parts: Vec<crate::page::SectionStatus> = made.iter().map(|made| section(made).verdict).collect();
    assert_eq!(parts[0], crate::page::SectionStatus::Broken("nothing was not run".to_owned()));
    assert_eq!(parts[2], crate::page::SectionStatus::Shown);
}

/// An empty folder of this test.
fn folder(name: &str) -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!("interplay-figures-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}
