//! Reads the tables of gains of a scenario when the scenario is loaded; their faults are reported then, with their lines.

use interplay_building::occupancy::ZoneRecord;
use interplay_building::series::SeriesError;
use interplay_common::spelling::suggestion;

use super::series_file::SeriesFile;
use crate::format::read::tree::TomlNode;
use crate::model::building::gains::{GainsConfig, RecordedGainsFile};
use crate::model::scenario::Scenario;
use crate::text::error::Fault;

/// Errors in gains are listed after those in the scenario.
const RANK: usize = 1002;

/// Reads table `index` of the gains; and a remark on the columns that are not zones.
pub(crate) fn read(
    stated: GainsConfig,
    index: usize,
    scenario: &Scenario,
    tree: &TomlNode,
) -> Result<(RecordedGainsFile, Option<Fault>), Fault> {
    let file = SeriesFile::read(&stated.file, &format!("gains.{index}.file"), tree, "table of gains", RANK)?;
    let network = scenario.building.as_ref().and_then(|building| building.network().ok());
    let start = file.start(scenario, stated.skip_days);
    let (mut zones, mut others) = (Vec::new(), Vec::new());
    for column in &file.table.columns {
        let Some(zone) = network.as_ref().and_then(|network| network.zone(&column.title)) else {
            others.push(format!("`{}`", column.title));
            continue;
        };
        let mut heat_kw = file.held(column, start.start_s, scenario.days(), stated.repeats)?;
        heat_kw.values.iter_mut().for_each(|value| *value *= stated.unit_kw);
        zones.push(ZoneRecord { zone, heat_kw, beside_people: stated.beside_people, is_forecast: stated.is_forecast });
    }
    let line = file.table.header_line;
    if let (true, Some(network)) = (zones.is_empty(), &network) {
        let names: Vec<&str> = network.names()[..network.zone_count()].iter().map(String::as_str).collect();
        let first = file.table.titles().first().copied().unwrap_or_default().to_owned();
        let problem = format!("no column is called like a zone; {}", suggestion(&first, "the zones are", &names));
        return Err(file.fault(&SeriesError { line, problem }));
    }
    let remark = (!others.is_empty()).then(|| {
        let problem = format!("not read, since no zone is called so: {}", others.join(", "));
        file.remark(&SeriesError { line, problem })
    });
    Ok((RecordedGainsFile { found: file.found, stated, zones }, remark))
}
