//! Contacts of which a vehicle is at fault, and gaps that it makes too short ([`Faults`](crate::measure::Faults) has the rules).

use interplay_scenarios::MetricKind::{Count, Flag};
use interplay_scenarios::{MetricComparison, MetricDeclaration, Scenario};

use crate::measure::metric::{Measurement, Metric, Needs, ObservedMoment, ObservedTick};
use crate::measure::values::{Measured, MetricValue};
use crate::state::frame::{Collision, Frame};

const BY_EGO_DOC: &str = "Whether the ego is at fault in its first contact: it took the right of way of the other, came out of its lane \
                          towards it, came into its way with a shorter gap than it owes, or ran into it while it stood; where no \
                          rule says so, it moved towards the other at least as fast as the other towards it";
const AT_FAULT_DOC: &str = "In how many contacts it is at fault, by the rules of `contact_by_ego`";
const CUT_INS_DOC: &str =
    "How often it comes into the way of a vehicle behind it with a shorter gap than it owes, among people";

pub(super) const METRICS: &[&dyn Metric] = &[
    &ContactMetric {
        declaration: MetricDeclaration::of_run("contact_by_ego", Flag, BY_EGO_DOC),
        value: |counts| MetricValue::Flag(counts.is_first_at_fault == Some(true)),
    },
    &ContactMetric {
        declaration: MetricDeclaration::of_vehicle("contacts_at_fault", Count, AT_FAULT_DOC)
            .compared(MetricComparison::Sum)
            .with_others(),
        value: |counts| MetricValue::Count(counts.at_fault),
    },
    &ContactMetric {
        declaration: MetricDeclaration::of_vehicle("cut_ins", Count, CUT_INS_DOC)
            .compared(MetricComparison::Sum)
            .with_others(),
        value: |counts| MetricValue::Count(counts.cut_ins),
    },
];

#[derive(Clone, Copy, Debug)]
struct ContactMetric {
    declaration: MetricDeclaration,
    value: fn(&Counts) -> MetricValue,
}

impl Metric for ContactMetric {
    fn declaration(&self) -> MetricDeclaration {
        self.declaration
    }

    fn needs(&self) -> Needs {
        Needs { faults: true, ..Needs::STATES }
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        Box::new(Counts { value: self.value, vehicle, is_first_at_fault: None, at_fault: 0, cut_ins: 0 })
    }
}

/// What one vehicle is at fault for so far.
#[derive(Clone, Copy, Debug)]
struct Counts {
    value: fn(&Counts) -> MetricValue,
    vehicle: usize,
    /// Whether it is at fault in its first contact; none before.
    is_first_at_fault: Option<bool>,
    at_fault: u64,
    cut_ins: u64,
}

impl Counts {
    fn count(&mut self, frame: &Frame, name: &str) {
        let is_at_fault = |contact: &Collision| contact.fault.as_ref().is_some_and(|fault| fault.vehicle == name);
        let own = frame.collisions.iter().filter(|contact| contact.between.iter().any(|one| one == name));
        for contact in own {
            self.is_first_at_fault.get_or_insert(is_at_fault(contact));
            self.at_fault += u64::from(is_at_fault(contact));
        }
        self.cut_ins += frame.cut_ins.iter().filter(|one| *one == name).count() as u64;
    }
}

impl Measurement for Counts {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        if let Some(vehicle) = tick.frame.vehicles.get(self.vehicle) {
            self.count(tick.frame, &vehicle.name);
        }
    }

    fn measured(&self) -> Measured {
        Measured { value: Some((self.value)(self)), ..Measured::default() }
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(*self)
    }
}
