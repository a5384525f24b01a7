//! Makes a report from a fitted network.

use std::cell::RefCell;
use std::ops::Range;

use interplay_common::spelling::counted;

use super::export::identified_network;
use super::heat_balance;
use super::innovations::whiteness;
use super::likelihood::{Filtered, Observations, filter};
use super::network_run::{FreeRunErrors, NetworkRun};
use super::profile::{Estimated, Profiler};
use super::quantities::{Precision, QuantityKind};
use super::selection::{Choice, Sandwich};
use super::trust::{QuantityEvidence, ZoneEvidence, judge};
use super::wrong_world::halves::{Agreement, Halves};
use super::wrong_world::{self, World};
use crate::identify::IdentifyError;
use crate::identify::diagnostics::{Confidence, ParameterVerdict};
use crate::identify::free_run::ResidualForecast;
use crate::identify::report::{
    CrossCheck, ErrorReport, FreeRunReport, Identification, IdentificationReport, Quantity, Suspicion, WallReport,
    ZoneReport, ZoneSeries,
};
use crate::identify::settings::{IdentifySettings, TrainTestSplit};
use crate::identify::telemetry::{Neighbour, Telemetry};

/// Everything that a report is made from.
pub(super) struct StateSpaceFindings<'a> {
    pub telemetry: &'a Telemetry,
    pub settings: &'a IdentifySettings,
    pub split: &'a TrainTestSplit,
    /// The rows trained on, and all rows.
    pub train: &'a Observations,
    pub all: &'a Observations,
    pub choice: &'a Choice,
}

/// What speaks against numbers.
struct Doubts {
    suspicions: Vec<Suspicion>,
    halves: Option<Halves>,
}

/// Errors on some rows, one a zone.
struct Errors {
    one_step_k: Vec<f64>,
    free: FreeRunErrors,
}

impl StateSpaceFindings<'_> {
    /// The report, the series to draw, and the network.
    ///
    /// # Errors
    /// [`IdentifyError::NotFinite`].
    pub fn identification(&self) -> Result<Identification, IdentifyError> {
        let fit = &self.choice.chosen;
        let model = |theta: &[super::exponential::Number]| fit.structure.model(theta);
        let filtered = filter(&model, &fit.maximum.theta, self.all).ok_or(IdentifyError::NotFinite)?;
        let run = NetworkRun::new(self.telemetry, self.all, fit, &filtered).ok_or(IdentifyError::NotFinite)?;
        let train = self.errors(&run, &filtered, &self.split.train);
        let test = (!self.split.test.is_empty()).then(|| self.errors(&run, &filtered, &self.split.test));
        let profiler = Profiler {
            telemetry: self.telemetry,
            observations: self.train,
            fit,
            precision: Precision::new(fit),
            larger: self.choice.larger.as_ref().map(|larger| (larger, Precision::new(larger))),
            rivals: self.choice.rivals.iter().map(|rival| (rival, Precision::new(rival))).collect(),
            sandwich: Sandwich::new(fit, self.train),
            known: RefCell::default(),
        };
        let halves = Halves::new(fit, self.train);
        let contradictions = match &halves {
            Some(halves) if self.scale_is_known() => halves.explanations(&profiler),
            _ => Vec::new(),
        };
        let world = World {
            telemetry: self.telemetry,
            observations: self.train,
            fit,
            smaller: &self.choice.smaller,
            precision: &profiler.precision,
            filtered: &filtered,
        };
        let suspicions = wrong_world::suspicions(&world, contradictions);
        let doubts = Doubts { suspicions, halves };
        let zones: Vec<ZoneReport> = (0..self.telemetry.zones.len())
            .map(|zone| self.zone(zone, (&profiler, &doubts), &filtered, (&train, test.as_ref())))
            .collect();
        let report = IdentificationReport {
            method: self.settings.method,
            step_s: self.telemetry.step_s,
            rows: self.telemetry.rows(),
            train_rows: self.split.train.iter().map(Range::len).sum(),
            left_out_rows: self.telemetry.left_out_rows,
            segments: self.telemetry.segments.len(),
            warnings: self.warnings(&zones, &train, &doubts.suspicions),
            suspicions: doubts.suspicions,
            walls: self.walls(&profiler),
            models: self.choice.table.clone(),
            zones,
        };
        let network = identified_network(&profiler, self.scale_is_known());
        Ok(Identification { report, series: self.series(&run, &filtered), network })
    }

    fn zone(
        &self,
        zone: usize,
        (profiler, doubts): (&Profiler<'_>, &Doubts),
        filtered: &Filtered,
        (train, test): (&Errors, Option<&Errors>),
    ) -> ZoneReport {
        let whiteness = whiteness(self.train, &self.choice.chosen, filtered, zone);
        let free_run_k = (train.free.runs > 0).then(|| (train.free.network_k[zone], train.free.mean_k[zone]));
        let evidence = ZoneEvidence { whiteness: &whiteness, free_run_k, suspicions: self.words_of(zone, doubts) };
        let kinds = QuantityKind::of_zone(self.telemetry, &profiler.fit.structure, zone);
        let physical = kinds
            .into_iter()
            .filter_map(|kind| self.quantity((kind, zone), (profiler, doubts), filtered, &evidence))
            .collect();
        ZoneReport {
            name: self.telemetry.zones[zone].name.clone(),
            coefficients: Vec::new(),
            physical,
            correlations: Vec::new(),
            condition_number: None,
            residual_model: None,
            train: self.error_report(train, zone),
            test: test.map(|test| self.error_report(test, zone)),
            whiteness,
        }
    }

    fn quantity(
        &self,
        (kind, zone): (QuantityKind, usize),
        (profiler, doubts): (&Profiler<'_>, &Doubts),
        filtered: &Filtered,
        zone_evidence: &ZoneEvidence<'_>,
    ) -> Option<Quantity> {
        let (name, symbol, unit) = kind.labels(self.telemetry);
        if kind.needs_scale() && !self.scale_is_known() {
            let reason = "no heat of a known unit was measured, and only that sets the scale";
            let words = format!("{name} cannot be identified: {reason}");
            let verdict = ParameterVerdict { confidence: Confidence::NotIdentifiable, words };
            return Some(quantity((name, symbol, unit), None, verdict, Vec::new()));
        }
        let estimated = profiler.estimated(kind, zone)?;
        let evidence = QuantityEvidence {
            balance: self.balance(kind, zone, filtered),
            larger: profiler.of_larger((kind, zone)).map(|(value, _)| libm::exp(value)),
            halves: self
                .agreement(profiler, doubts.halves.as_ref(), (kind, zone))
                .filter(Agreement::is_contradiction)
                .map(|agreement| agreement.values),
            scales_with_heat: kind.needs_scale(),
        };
        let verdict = judge(&name, &estimated, zone_evidence, &evidence);
        let mut checks = Vec::new();
        if let Some(balance) = evidence.balance {
            let how = "by the heat balance over the record".into();
            checks.push(CrossCheck { how, value: Some(balance.value), standard_error: Some(balance.standard_error) });
        }
        if let Some(larger) = evidence.larger {
            checks.push(CrossCheck {
                how: "by the next larger model".into(),
                value: Some(larger),
                standard_error: None,
            });
        }
        Some(quantity((name, symbol, unit), Some(&estimated), verdict, checks))
    }

    /// What the halves of the record say of a quantity.
    fn agreement(
        &self,
        profiler: &Profiler<'_>,
        halves: Option<&Halves>,
        quantity: (QuantityKind, usize),
    ) -> Option<Agreement> {
        halves?.agreement(self.telemetry, quantity, profiler.inflation_of(quantity))
    }

    /// What speaks against all numbers of a zone.
    fn words_of(&self, zone: usize, doubts: &Doubts) -> Vec<String> {
        let name = &self.telemetry.zones[zone].name;
        let of_zone = doubts.suspicions.iter().filter(|it| it.zone.as_ref().is_none_or(|other| other == name));
        of_zone.map(|it| it.words.clone()).collect()
    }

    /// Whether some heat is in kW.
    fn scale_is_known(&self) -> bool {
        self.telemetry.zones.iter().any(|zone| zone.has_heat() && zone.power_has_unit)
    }

    fn balance(
        &self,
        kind: QuantityKind,
        zone: usize,
        filtered: &Filtered,
    ) -> Option<heat_balance::BalancedConductance> {
        let fit = &self.choice.chosen;
        let of = |neighbour| heat_balance::conductance(self.telemetry, self.train, fit, filtered, (zone, neighbour));
        match kind {
            QuantityKind::Conductance(neighbour) => of(neighbour),
            QuantityKind::Resistance(neighbour) => of(neighbour).map(|balance| heat_balance::BalancedConductance {
                value: 1.0 / balance.value,
                standard_error: balance.standard_error / (balance.value * balance.value),
            }),
            _ => None,
        }
    }

    /// A quantity by another fit.
    fn errors(&self, run: &NetworkRun<'_>, filtered: &Filtered, segments: &[Range<usize>]) -> Errors {
        let p = self.all.widths.0;
        let one_step = |zone: usize| {
            let values = segments.iter().flat_map(Clone::clone).map(|row| filtered.innovations[row * p + zone]);
            root_mean_square(values)
        };
        let trained = |zone: usize| {
            let temperature = &self.telemetry.zones[zone].temperature_c;
            let rows = self.split.train.iter().flat_map(Clone::clone);
            let (sum, count) = rows
                .map(|row| temperature[row])
                .filter(|value| value.is_finite())
                .fold((0.0, 0_usize), |(sum, count), value| (sum + value, count + 1));
            sum / count.max(1) as f64
        };
        let mean_c: Vec<f64> = (0..p).map(trained).collect();
        let horizon = self.settings.horizon_steps(self.telemetry.step_s);
        Errors { one_step_k: (0..p).map(one_step).collect(), free: run.errors(segments, horizon, &mean_c) }
    }

    fn error_report(&self, errors: &Errors, zone: usize) -> ErrorReport {
        let runs = errors.free.runs;
        let of = |values: &[f64]| (runs > 0).then(|| values[zone]);
        ErrorReport {
            one_step_k: errors.one_step_k[zone],
            one_step_with_residual_model_k: None,
            free_run: FreeRunReport {
                horizon_h: self.settings.horizon_steps(self.telemetry.step_s) as f64 * self.telemetry.step_s / 3600.0,
                runs,
                errors_k: vec![(ResidualForecast::None, of(&errors.free.network_k))],
                mean_of_data_k: of(&errors.free.mean_k),
            },
        }
    }

    /// Walls between zones. Both sides share one conductance.
    fn walls(&self, profiler: &Profiler<'_>) -> Vec<WallReport> {
        let wall = |(one, other): (usize, usize)| {
            let estimated = profiler.estimated(QuantityKind::Conductance(Neighbour::Zone(other)), one);
            let known = estimated.filter(|it| it.log_error.is_finite());
            let combined = known.map(|it| (it.value, it.value * it.log_error));
            let name = |zone: usize| self.telemetry.zones[zone].name.clone();
            let words = match combined {
                Some(_) => "one conductance for both sides".into(),
                None => "not determined".into(),
            };
            WallReport { between: (name(one), name(other)), from_first: None, from_second: None, combined, words }
        };
        let pairs = self.telemetry.walls.iter().filter_map(|wall| match wall.other {
            Neighbour::Zone(other) => Some((wall.zone, other)),
            Neighbour::Boundary(_) => None,
        });
        pairs.map(wall).collect()
    }

    fn warnings(&self, zones: &[ZoneReport], train: &Errors, suspicions: &[Suspicion]) -> Vec<String> {
        let of = |it: &Suspicion| match &it.zone {
            Some(zone) => format!("{zone}: {}", it.words),
            None => it.words.clone(),
        };
        let mut warnings: Vec<String> = zones.iter().filter_map(useless_for_control).collect();
        warnings.extend(suspicions.iter().map(of));
        for row in self.choice.table.iter().filter(|row| row.search_failed) {
            warnings
                .push(format!("the search for the best `{}` failed: it contains a model that is better", row.model));
        }
        if self.telemetry.left_out_rows > 0 {
            let rows = counted(self.telemetry.left_out_rows, "row");
            warnings.push(format!("{rows} left out because a value is missing"));
        }
        if !self.choice.chosen.maximum.converged {
            warnings.push("the ascent of the likelihood did not end: the estimate may not be the best".into());
        }
        for zone in zones {
            let doubtful = zone.physical.iter().filter(|it| it.verdict.confidence != Confidence::Identified);
            doubtful.for_each(|it| warnings.push(format!("{}: {}", zone.name, it.verdict.words)));
            if zone.whiteness.ljung_box.p_value < 0.05 {
                warnings.push(format!("{}: residuals are {}", zone.name, zone.whiteness.words));
            }
        }
        if train.free.runs == 0 {
            let horizon_h = self.settings.horizon_h;
            let words = "no stretch without a gap is long enough for a free run";
            warnings.push(format!("{words} of {horizon_h} h: lower `horizon_h`"));
        }
        warnings
    }

    fn series(&self, run: &NetworkRun<'_>, filtered: &Filtered) -> Vec<ZoneSeries> {
        let p = self.all.widths.0;
        let free = run.restarted(self.settings.horizon_steps(self.telemetry.step_s));
        let draw = |(zone, free_run_c): (usize, Vec<f64>)| {
            let measured = &self.telemetry.zones[zone];
            let innovations: Vec<f64> = filtered.innovations.iter().skip(zone).step_by(p).copied().collect();
            let one_step = |(measured, innovation): (&f64, &f64)| {
                if innovation.is_finite() { measured - innovation } else { *measured }
            };
            ZoneSeries {
                name: measured.name.clone(),
                time_s: self.telemetry.time_s.clone(),
                segment_starts: self.telemetry.segments.iter().map(|segment| segment.start).collect(),
                test_start: self.split.test_start,
                measured_c: measured.temperature_c.clone(),
                one_step_c: measured.temperature_c.iter().zip(&innovations).map(one_step).collect(),
                free_run_c,
                free_run_with_residual_model_c: None,
                innovations_k: innovations,
            }
        };
        free.into_iter().enumerate().map(draw).collect()
    }
}

/// Says that the network alone predicts a zone worse than the mean of the data, if it does: then no number matters.
fn useless_for_control(zone: &ZoneReport) -> Option<String> {
    let free = &zone.train.free_run;
    let network_k = free.errors_k.iter().find_map(|(_, error_k)| *error_k)?;
    let mean_k = free.mean_of_data_k.filter(|mean_k| network_k >= *mean_k)?;
    Some(format!(
        "{}: do not use this model for control: over {:.0} h it errs by {network_k:.2} K, and the mean of the data by \
         {mean_k:.2} K",
        zone.name, free.horizon_h
    ))
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let squares = values.filter(|value| value.is_finite()).map(|value| value * value);
    let (sum, count) = squares.fold((0.0, 0_usize), |(sum, count), square| (sum + square, count + 1));
    libm::sqrt(sum / count.max(1) as f64)
}

/// A quantity with its labels; without an estimate it has no numbers. Where an end of the interval is missing, only the other
/// end is known.
fn quantity(
    (name, symbol, unit): (String, &str, &str),
    estimated: Option<&Estimated>,
    verdict: ParameterVerdict,
    checks: Vec<CrossCheck>,
) -> Quantity {
    let interval = estimated.map_or((None, None), |estimated| estimated.interval);
    let known = estimated.filter(|_| interval.0.is_some() && interval.1.is_some());
    Quantity {
        name,
        symbol: symbol.into(),
        unit: unit.into(),
        value: known.map(|known| known.value),
        standard_error: known.map(|known| known.value * known.log_error),
        interval,
        verdict,
        checks,
    }
}
