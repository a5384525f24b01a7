//! The reference page of all metrics, generated from their declarations.

use interplay_scenarios::{Better, MetricComparison, MetricDeclaration, MetricKind, MetricSubject, RegisteredMetrics};

use super::registered::metrics_of;

const HEAD: &str = "# Every metric\n\n\
    This page is made of what the metrics declare of themselves.\n\n\
    - *Name*: the column in rows of [sweeps](../guide/sweeps.md), which of a metric of vehicles has the value of the ego; the name in\n  \
    `[[expect.metric]]`; and without another *key*, the key in the [report](../guide/output.md), below `vehicles[]` if each vehicle has a\n  \
    value of its own.\n\
    - *Unit*: none for flags, counts, and shares.\n\
    - *Compared*: what `interplay compare` tells. Of pairs of runs it counts which has the better value where a direction is\n  \
    stated. A metric with *others* has a second column, `others_NAME`: the worst value of the other vehicles.\n\n";

/// The reference page of all metrics as Markdown.
pub fn metric_table(registered: &RegisteredMetrics) -> String {
    let mut page = format!("{HEAD}| name | of | key | unit | compared | what |\n|---|---|---|---|---|---|\n");
    for declaration in metrics_of(registered).map(|metric| metric.declaration()) {
        page += &row(&declaration);
    }
    page
}

fn row(declaration: &MetricDeclaration) -> String {
    let MetricDeclaration { name, doc, kind, of, report_key, comparison, better, others, .. } = declaration;
    let of = match of {
        MetricSubject::Run => "the run",
        MetricSubject::Vehicle => "vehicles",
    };
    let unit = match (declaration.unit(), kind) {
        (Some(unit), _) => unit,
        (None, MetricKind::Flag) => "true or false",
        (None, MetricKind::Count | MetricKind::Number) => "",
    };
    let comparison = comparison.map(|comparison| match comparison {
        MetricComparison::Share => "share",
        MetricComparison::Sum => "sum",
        MetricComparison::Mean => "mean",
        MetricComparison::Quantiles => "quantiles",
    });
    let better = better.filter(|_| comparison.is_some()).map(|better| match better {
        Better::Lower => "lower is better",
        Better::Higher => "higher is better",
    });
    let compared: Vec<&str> = comparison.into_iter().chain(better).chain(others.then_some("others")).collect();
    let key = report_key.map_or_else(String::new, |key| format!("`{key}`"));
    format!("| `{name}` | {of} | {key} | {unit} | {} | {doc} |\n", compared.join(", "))
}
