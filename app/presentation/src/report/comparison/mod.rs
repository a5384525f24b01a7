//! Comparisons of planners, and of versions, as text and as a page.

mod page;
mod rows;

pub use page::{comparison_page, version_comparison_page};

use interplay_common::spelling::counted;
use interplay_sweep::compare::{Comparison, PairedDifference, VersionComparison};

use self::rows::{TextRows, differences, figures, heading, version_name, versus};
use crate::report::columns::{Align, lines_within};

/// Characters of a line after its indentation: a terminal of 100 shows it whole.
const WIDTH: usize = 98;

/// The figures of every planner as text, and below each group its differences from the baseline.
pub fn comparison(comparison: &Comparison) -> String {
    let mut text = format!("{}, {} of them without a result\n", counted(comparison.runs, "run"), comparison.unfinished);
    for group in &comparison.groups {
        text += &format!("\n{}\n", heading(group));
        text.extend(figures(group).iter().map(indented));
        let versus = versus(group);
        if !versus.is_empty() {
            text += &format!("  versus {}, under the same conditions\n", comparison.baseline);
            text.extend(versus.iter().map(indented));
        }
    }
    text += "\n* unlikely to be chance: below 5 % after Holm's correction for all tests of a kind\n";
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
        text.extend(differences(&changed, comparison.has_vehicles).iter().map(indented));
        text += "\n* unlikely to be chance: below 5 % after Holm's correction for all tests of a kind\n";
    }
    text
}

fn indented((header, rows): &TextRows) -> String {
    let header: Vec<(&str, Align)> = header.iter().map(|title| (title.as_str(), Align::Left)).collect();
    let lines = lines_within(WIDTH, &header, rows);
    lines.into_iter().map(|line| if line.is_empty() { "\n".to_owned() } else { format!("  {line}\n") }).collect()
}
