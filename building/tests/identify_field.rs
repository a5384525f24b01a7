//! Records as plants make them: a thermostat that switches inside rows, a wrong clock, electricity in place of heat.

use interplay_building::identify::{
    Confidence, IdentificationReport, IdentifySettings, Mapping, Quantity, SuspectedCause, Telemetry, identify,
};

fn record(name: &str) -> Telemetry {
    let path = format!("{}/tests/cases/{name}", env!("CARGO_MANIFEST_DIR"));
    let read = |ending: &str| std::fs::read_to_string(format!("{path}{ending}")).expect("part of the repository");
    let mapping = Mapping::parse("mapping.toml", &read(".toml")).expect("sound");
    Telemetry::read("record.csv", &read(".csv"), &mapping).expect("sound")
}

fn report(name: &str) -> IdentificationReport {
    identify(&record(name), &IdentifySettings::default()).expect("rich data").report
}

fn quantity<'a>(report: &'a IdentificationReport, name: &str) -> &'a Quantity {
    let all = &report.zones[0].physical;
    all.iter().find(|quantity| quantity.name == name).unwrap_or_else(|| panic!("no quantity `{name}`"))
}

/// The truth: 0.17316 kW/K, 32,250 kJ/K and 2.212 m². The heat in the rows is a mean; the thermostat switched inside them.
#[test]
fn a_thermostat_that_switches_inside_rows_raises_no_alarm() {
    let found = report("thermostat-in-rows");
    assert!(found.suspicions.is_empty(), "{:?}", found.suspicions);
    for (name, truth, share) in [("conductance to outdoor", 0.17316, 0.01), ("heat capacity", 32_250.0, 0.1)] {
        let found = quantity(&found, name);
        assert_eq!(found.verdict.confidence, Confidence::Identified, "{found:?}");
        assert!((found.value.expect("known") / truth - 1.0).abs() < share, "{found:?}");
    }
    let chosen = found.models.iter().find(|model| model.chosen).expect("one is chosen");
    assert!(!chosen.model.contains("heater"), "{}", chosen.model);
}

/// The clock of the weather is an hour off. The truth: 22.7 MJ/K and 0.59 m².
#[test]
fn a_wrong_clock_makes_no_impossible_part_known() {
    let found = report("clock-one-hour-off");
    for quantity in &found.zones[0].physical {
        if quantity.unit == "m²" || quantity.name.contains("capacity") {
            assert_ne!(quantity.verdict.confidence, Confidence::Identified, "{quantity:?}");
        }
        if let Some(high) = quantity.interval.1 {
            assert!(quantity.unit != "kJ/K" || high < 1e6, "{quantity:?}");
            assert!(quantity.unit != "m²" || high < 1e3, "{quantity:?}");
        }
    }
}

/// The electricity of a heat pump is recorded as heat. The truth: 0.1887 kW/K, which these data cannot show.
#[test]
fn electricity_that_is_recorded_as_heat_is_named() {
    let found = report("heat-pump-electricity");
    let conductance = quantity(&found, "conductance to outdoor");
    assert_ne!(conductance.verdict.confidence, Confidence::Identified, "{conductance:?}");
    assert_eq!(
        found.suspicions.first().map(|it| it.cause),
        Some(SuspectedCause::VaryingGain),
        "{:?}",
        found.suspicions
    );
}
