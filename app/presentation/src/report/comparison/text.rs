//! Comparisons as text.

use interplay_sweep::compare::{Comparison, VersionComparison};

use super::rows::{DIFFERENCES, FIGURES, difference, figures, heading, version_name};
use crate::report::columns::{Align, lines};

/// The figures of every planner, and below each group its differences from the baseline.
pub fn comparison(comparison: &Comparison) -> String {
    let mut text = format!("{} runs, {} of them without a result\n", comparison.runs, comparison.unfinished);
    for group in &comparison.groups {
        text += &format!("\n{}\n", heading(group));
        text += &indented(&FIGURES, group.planners.iter().map(figures));
        let versus = group.planners.iter().filter_map(|planner| {
            Some(difference(&planner.planner, planner.versus_baseline.as_ref().filter(|versus| versus.pairs > 0)?))
        });
        let versus: Vec<Vec<String>> = versus.collect();
        if !versus.is_empty() {
            text += &format!("  versus {}, under the same conditions\n", comparison.baseline);
            text += &indented(&DIFFERENCES, versus);
        }
    }
    text += "\n* unlikely to be chance: below 5 % after Holm's correction for all tests of a kind\n";
    text
}

/// What the second of two folders does differently.
pub fn version_comparison(comparison: &VersionComparison) -> String {
    let [before, after] = comparison.versions.each_ref().map(|versions| versions.join(", "));
    let VersionComparison { pairs, changed, unpaired: [only_before, only_after], .. } = comparison;
    let mut text = format!(
        "first: {before}\nsecond: {after}\n{pairs} pairs of runs, {changed} of them differ; without a pair: {only_before} of the \
         first, {only_after} of the second\n"
    );
    let groups = comparison.groups.iter().filter(|group| group.changed > 0);
    let rows: Vec<Vec<String>> = groups.map(|group| difference(&version_name(group), &group.difference)).collect();
    if !rows.is_empty() {
        text += "\nthe second versus the first, where any run differs\n";
        text += &indented(&DIFFERENCES, rows);
        text += "\n* unlikely to be chance: below 5 % after Holm's correction for all tests of a kind\n";
    }
    text
}

fn indented(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let header: Vec<(&str, Align)> = header.iter().map(|title| (*title, Align::Left)).collect();
    lines(&header, rows).into_iter().map(|line| format!("  {line}\n")).collect()
}
