//! Comparisons of planners, and of versions, as text and as a page.

mod rows;

use interplay_common::spelling::counted;
use interplay_sweep::compare::{Comparison, GroupFigures, PairedDifference, PlannerFigures, Share, VersionComparison};

use crate::page::{Page, Section};
use crate::plot::{IntervalBar, IntervalBars, PlotError, TextTable};
use crate::report::columns::{Align, lines_within};
pub use rows::ShownFigures;
use rows::{TextRows, differences, figures, heading, version_name, versus};

/// Characters of a line after its indentation: a terminal of 100 shows it whole.
const WIDTH: usize = 98;

/// The figures of every planner as text, and below each group its differences from the baseline.
pub fn comparison(comparison: &Comparison, shown: ShownFigures) -> String {
    let mut text = format!("{}, {} of them without a result\n", counted(comparison.runs, "run"), comparison.unfinished);
    for group in &comparison.groups {
        text += &format!("\n{}\n", heading(group));
        text.extend(figures(group, shown).iter().map(indented));
        let versus = versus(group, shown);
        if !versus.is_empty() {
            text += &format!("  versus {}, under the same conditions\n", comparison.baseline);
            text.extend(versus.iter().map(indented));
        }
    }
    text += "\n* unlikely to be chance: below 5 % after Holm's correction for all tests of a kind\n";
    if shown == ShownFigures::First && comparison.groups.iter().any(|group| group.has_vehicles) {
        text += "`interplay compare --all` shows the other figures: braking, gaps, comfort, rules and times of plans\n";
    }
    text
}

/// The differences of the second of two folders from the first, as text.
pub fn version_comparison(comparison: &VersionComparison) -> String {
    let [before, after] = comparison.versions.each_ref().map(|versions| versions.join(", "));
    let VersionComparison { pairs, changed, unpaired: [only_before, only_after], .. } = comparison;
    let mut text = format!(
        "first: {before}\nsecond: {after}\n{pairs} pairs of runs, {changed} of them differ; without a pair: {only_before} of the \
         first, {only_after} of the second\n"
    );
    let groups = comparison.groups.iter().filter(|group| group.changed > 0);
    let changed: Vec<(String, &PairedDifference)> =
        groups.map(|group| (version_name(group), &group.difference)).collect();
    if !changed.is_empty() {
        text += "\nthe second versus the first, where any run differs\n";
        text.extend(differences(&changed, comparison.has_vehicles, ShownFigures::All).iter().map(indented));
        text += "\n* unlikely to be chance: below 5 % after Holm's correction for all tests of a kind\n";
    }
    text
}

fn indented((header, rows): &TextRows) -> String {
    let header: Vec<(&str, Align)> = header.iter().map(|title| (title.as_str(), Align::Left)).collect();
    let lines = lines_within(WIDTH, &header, rows);
    lines.into_iter().map(|line| if line.is_empty() { "\n".to_owned() } else { format!("  {line}\n") }).collect()
}

const LEGEND: [&str; 3] = [
    "Success: the ego reached its goal without a contact. Stuck: it never reached its goal, although no vehicles touched. First: it \
     had the first place in the order, or on a network no vehicle went before it. As in the file: the order and right of way that \
     the scenario expects, without a contact. Contacts by the ego: it moved towards the other vehicle at least as fast as the other \
     towards it; any: of any two vehicles. Yields: in a conflict zone of a network the other vehicle went first, or the ego did. \
     Brakes hard: with at least 75 % of its strongest braking.",
    "Intervals of shares are Wilson's, those of means are bootstrapped, at 95 %. Pairs are runs of the same scenario, style, \
     sample and seed. Place: without a contact where the other run has one, or nearer to the front of the order, which is not \
     a quality. p is the probability of a split at least as uneven if both were equally good (McNemar's exact test), after \
     Holm's correction for all tests of its kind on the page; a star marks those below 5 %.",
    "Times of plans are wall times of the machine that made the runs.",
];

/// The page of a comparison of planners.
///
/// # Errors
/// [`PlotError`] if a picture cannot be drawn.
pub fn comparison_page(title: &str, comparison: &Comparison) -> Result<Page, PlotError> {
    let Comparison { runs, unfinished, versions, baseline, groups } = comparison;
    let summary = format!(
        "{}, {unfinished} of them without a result; compared with {baseline}; made by version {}.",
        counted(*runs, "run"),
        versions.join(", ")
    );
    let opening = std::iter::once(summary).chain(LEGEND.map(str::to_owned)).collect();
    let mut sections: Vec<Section> = Vec::new();
    for group in groups {
        let family = group.family.clone().unwrap_or_else(|| "all".to_owned());
        if sections.last().is_none_or(|section| section.heading != family) {
            let same = groups.iter().filter(|other| other.family == group.family);
            sections.push(section(sections.len(), family, same.collect(), baseline)?);
        }
    }
    // The section of all families comes first.
    sections.rotate_right(usize::from(groups.iter().any(|group| group.family.is_none())));
    Ok(Page { title: title.to_owned(), opening, sections })
}

fn section(index: usize, family: String, groups: Vec<&GroupFigures>, baseline: &str) -> Result<Section, PlotError> {
    let bars = |title: &str, axis: &str, end, of: fn(&PlannerFigures) -> IntervalBar| IntervalBars {
        title: title.to_owned(),
        axis: axis.to_owned(),
        end,
        groups: groups.iter().map(|group| (heading(group), group.planners.iter().map(of).collect())).collect(),
    };
    let success = bars("Success", "share of runs, with intervals of 95 %", Some(1.0), |planner| IntervalBar {
        name: planner.planner.clone(),
        value: planner.figures.share("success").and_then(Share::share),
        interval: planner.figures.share("success").filter(|share| share.of > 0).map(|share| share.interval),
    });
    let time =
        bars("Time to the goal", "mean of successful runs [s], with intervals of 95 %", None, |planner| IntervalBar {
            name: planner.planner.clone(),
            value: planner.figures.mean("completed_s").map(|time| time.mean),
            interval: planner.figures.mean("completed_s").map(|time| time.interval),
        });
    let mut pictures = vec![("success of each planner".to_owned(), success.draw().svg()?)];
    if groups.iter().any(|group| group.planners.iter().any(|planner| planner.figures.mean("completed_s").is_some())) {
        pictures.push(("time to the goal of each planner".to_owned(), time.draw().svg()?));
    }
    let mut tables = Vec::new();
    for group in groups {
        tables.extend(figures(group, ShownFigures::All).into_iter().map(|of| table(heading(group), of)));
        let title = format!("{}, versus {baseline}", heading(group));
        tables.extend(versus(group, ShownFigures::All).into_iter().map(|of| table(title.clone(), of)));
    }
    Ok(Section { id: format!("part-{index}"), heading: family, pictures, tables, ..Section::default() })
}

/// The page of a comparison of two versions.
pub fn version_comparison_page(title: &str, comparison: &VersionComparison) -> Page {
    let [before, after] = comparison.versions.each_ref().map(|versions| versions.join(", "));
    let VersionComparison { pairs, changed, unpaired: [only_before, only_after], groups, .. } = comparison;
    let summary = format!(
        "The first was made by version {before}, the second by {after}. {pairs} pairs of runs, {changed} of them differ; without a \
         pair: {only_before} of the first, {only_after} of the second."
    );
    let changed = groups.iter().filter(|group| group.changed > 0);
    let changed: Vec<(String, &PairedDifference)> =
        changed.map(|group| (version_name(group), &group.difference)).collect();
    let heading = "The second versus the first, where any run differs";
    let tables = differences(&changed, comparison.has_vehicles, ShownFigures::All);
    let tables: Vec<TextTable> = tables.into_iter().map(|of| table(heading.to_owned(), of)).collect();
    let section = Section { id: "changes".to_owned(), heading: "Changes".to_owned(), tables, ..Section::default() };
    let opening = std::iter::once(summary).chain([LEGEND[1].to_owned()]).collect();
    Page { title: title.to_owned(), opening, sections: vec![section] }
}

/// A table of planners; with more measures than planners it has one row per measure, since it would be wider than a page.
fn table(title: String, (header, rows): TextRows) -> TextTable {
    let table = TextTable { title, header, rows };
    if table.header.len() > table.rows.len() + 1 { table.transposed() } else { table }
}
