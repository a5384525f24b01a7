//! The registry is complete, every shot of it exists, every picture can be read, and a failure stays alone.

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
        for shot in entry.shots.iter().chain(entry.beside) {
            let sets: Vec<Override> = shot.sets.iter().map(|set| Override::Set((*set).to_owned())).collect();
            if let Err(error) = load(shot.scenario, &sets) {
                panic!("{entry}: {} with {:?}: {:?}", shot.scenario, shot.sets, error.faults());
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
        let exhibit = made.outcome.unwrap_or_else(|error| panic!("{entry}: {error}"));
        assert!(!exhibit.pictures.is_empty(), "{entry} has no picture");
        for picture in &exhibit.pictures {
            assert_eq!(picture.illegible(), Vec::<String>::new(), "{entry}");
            assert!(picture.mark_count() > picture.words().len() + 2, "{entry} has words only");
        }
        for ending in ["svg", "png"] {
            let file = folder.join(format!("{}.{ending}", entry.id()));
            assert!(std::fs::metadata(&file).is_ok_and(|file| file.len() > 1000), "{}", file.display());
        }
        // The source's own tables and parameters need no run; all else is measured.
        assert!(entry.kind == Kind::Table || !exhibit.sheets.is_empty(), "{entry} has nothing measured");
    }
    std::fs::remove_dir_all(folder).expect("it was made above");
}

/// Every axis has a unit, or is a number of something.
#[test]
fn every_axis_has_a_unit() {
    let take = Shot { label: "", scenario: "lane-change/front-nice", sets: &["duration_s=2"] }.take().expect("a run");
    let house = Shot { label: "", scenario: "building/distributed", sets: &["iterations=2"] }.take().expect("a run");
    let plots = [
        driving::motion("", &take),
        driving::speeds("", &take),
        driving::reasons("", &take, 0).expect("negotiation says what it thinks"),
        climate::temperatures("", &house, &[0, 1, 2, 3]),
        climate::inputs("", &house, &[0]),
        climate::weather("", &house),
        climate::disturbance("", &house, &[0]),
        climate::costs("", &[&house]),
        climate::rounds("", &house),
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
    shots: &[],
    beside: &[],
    draw: |_, _| Err("nothing there".to_owned()),
};
static MISSING: Entry = Entry {
    number: "0.2",
    shots: &[Shot { label: "", scenario: "no/such-scenario", sets: &[] }],
    draw: |_, _| Ok(Exhibit::default()),
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
    let outcomes: Vec<Result<(), &str>> =
        made.iter().map(|made| made.outcome.as_ref().map(|_| ()).map_err(String::as_str)).collect();
    assert_eq!(outcomes[0], Err("nothing there"));
    assert!(outcomes[1].is_err_and(|error| error.contains("no/such-scenario")), "{outcomes:?}");
    assert_eq!(outcomes[2], Ok(()));
    assert_eq!(steps.into_inner(), super::steps(&entries));
    let parts: Vec<crate::page::Verdict> = made.iter().map(|made| section(made).verdict).collect();
    assert_eq!(parts[0], crate::page::Verdict::Broken("nothing there".to_owned()));
    assert_eq!(parts[2], crate::page::Verdict::Shown);
}

/// An empty folder of this test.
fn folder(name: &str) -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!("interplay-figures-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}
