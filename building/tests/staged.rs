//! Problems of stages: the recursion's solution is that of an independent solver, and no other inputs are cheaper.

mod common;

use common::numbers;
use interplay_building::discretise::Model;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_building::staged::{HeatInput, Peak, PlanStage, SoftBound, StageMap, StagedProgram, solve};
use interplay_convex::{Program, Solver, SolverSettings};

const ZONES: usize = 3;

/// Three rooms in a row with a heavy outer wall each.
fn model() -> Model {
    let names = ["a", "b", "c"];
    let zones = names.map(Zone::named);
    let mut walls: Vec<Wall> = names.map(|name| Wall::new(name, AMBIENT, 20.0).with_capacity_kj_per_k(5000.0)).to_vec();
    walls.extend([Wall::new("a", "b", 15.0), Wall::new("b", "c", 25.0)]);
    Model::exact(&Network::new(&zones, &walls).expect("valid"), 1800.0).expect("valid")
}

/// A problem with heating and cooling, stages of one and of two steps, quadratic costs where `quadratic`, and a peak where stated.
fn problem(quadratic: f64, peak: Option<Peak>) -> StagedProgram {
    let model = model();
    let nodes = model.network().node_count();
    let inputs: Vec<HeatInput> = (0..ZONES).flat_map(|zone| [1.0, -1.0].map(|sign| HeatInput { zone, sign })).collect();
    let random = numbers(2000, 1.0);
    let stage = |t: usize| {
        let price = 0.3 + 0.2 * random[t];
        PlanStage {
            map: usize::from(t >= 6),
            drift_k: (0..nodes).map(|i| -0.25 + 0.3 * random[100 + 7 * t + i]).collect(),
            lower: vec![0.0; inputs.len()],
            upper: (0..inputs.len()).map(|j| 1.5 + random[300 + j]).collect(),
            linear: (0..inputs.len()).map(|j| price * (1.0 + 0.1 * j as f64)).collect(),
            quadratic: vec![quadratic; inputs.len()],
            nodes: vec![(t % ZONES, -quadratic * 20.0, quadratic)],
            soft: (0..ZONES)
                .filter(|zone| !(t + zone).is_multiple_of(3))
                .flat_map(|node| {
                    let (linear, quadratic) = (2.0, 1.0);
                    [(1.0, 22.0), (-1.0, -20.5)].map(|(sign, bound)| SoftBound { node, sign, bound, linear, quadratic })
                })
                .collect(),
            power: if peak.is_some() { vec![0.4; inputs.len()] } else { Vec::new() },
        }
    };
    StagedProgram {
        maps: [1, 2].map(|span| StageMap::new(&model, span)).to_vec(),
        initial_c: vec![21.0; nodes],
        stages: (0..12).map(stage).collect(),
        inputs,
        peak,
    }
}

/// The least cost as the sparse interior-point solver of `convex` finds it, from the responses of the temperatures to the inputs.
fn independent_cost(problem: &StagedProgram) -> f64 {
    let (m, n) = (problem.inputs.len(), problem.initial_c.len());
    let count = m * problem.stages.len();
    let free = problem.states(&vec![0.0; count]);
    let responses: Vec<Vec<f64>> = (0..count)
        .map(|j| {
            let mut unit = vec![0.0; count];
            unit[j] = 1.0;
            problem.states(&unit).iter().zip(&free).map(|(moved, free)| moved - free).collect()
        })
        .collect();
    let mut program = Program::new();
    let v = program.variables("inputs", count);
    let x = program.variables("states", free.len());
    let p = program.variables("peak", 1).at(0);
    let (states, limits) = (program.equal("states"), program.at_most("limits"));
    for (i, free) in free.iter().enumerate() {
        let moved = (0..count).map(|j| (v.at(j), -responses[j][i]));
        program.row(states, moved.chain([(x.at(i), 1.0)]).collect::<Vec<_>>(), *free);
    }
    for (t, stage) in problem.stages.iter().enumerate() {
        for j in 0..m {
            let v = v.at(t * m + j);
            program.row(limits, [(v, 1.0)], stage.upper[j]);
            program.row(limits, [(v, -1.0)], -stage.lower[j]);
            program.linear(v, stage.linear[j]);
            program.quadratic(v, v, stage.quadratic[j]);
        }
        for &(node, linear, quadratic) in &stage.nodes {
            program.linear(x.at(t * n + node), linear);
            program.quadratic(x.at(t * n + node), x.at(t * n + node), quadratic);
        }
        for (k, soft) in stage.soft.iter().enumerate() {
            let s = program.variables(format!("slack {t} {k}"), 1).at(0);
            program.row(limits, [(x.at(t * n + soft.node), soft.sign), (s, -1.0)], soft.bound);
            program.row(limits, [(s, -1.0)], 0.0);
            program.linear(s, soft.linear);
            program.quadratic(s, s, soft.quadratic);
        }
        if problem.peak.is_some() {
            let taken = (0..m).map(|j| (v.at(t * m + j), stage.power[j])).chain([(p, -1.0)]);
            program.row(limits, taken.collect::<Vec<_>>(), 0.0);
        }
    }
    program.linear(p, problem.peak.map_or(0.0, |peak| peak.price));
    program.row(limits, [(p, -1.0)], -problem.peak.map_or(0.0, |peak| peak.least_kw));
    Solver::new(&program, &SolverSettings::default()).expect("posed").solve().expect("solved").objective
}

#[test]
fn the_staged_solver_matches_an_independent_solver() {
    let peak = |price| Some(Peak { price, least_kw: 0.2 });
    for (quadratic, peak) in [(0.0, None), (0.05, None), (0.0, peak(1.5)), (0.05, peak(0.0))] {
        let problem = problem(quadratic, peak);
        let found = solve(&problem, 1e-9).expect("solved");
        let wanted = independent_cost(&problem);
        let error = (found.objective - wanted).abs() / wanted.abs();
        assert!(error < 1e-6, "{quadratic} {peak:?}: {} instead of {wanted}", found.objective);
    }
}

/// A price of the peak lowers the peak and does not lower the cost.
#[test]
fn a_price_on_the_peak_lowers_it() {
    let solved = |peak| solve(&problem(0.0, peak), 1e-8).expect("solved");
    let highest_kw = |inputs: &[f64]| inputs.chunks(2 * ZONES).map(|v| 0.4 * v.iter().sum::<f64>()).fold(0.0, f64::max);
    let (free, priced) = (solved(None), solved(Some(Peak { price: 5.0, least_kw: 0.0 })));
    assert!(highest_kw(&priced.inputs) < 0.9 * highest_kw(&free.inputs));
    assert!((highest_kw(&priced.inputs) - priced.peak_kw).abs() < 1e-3);
    assert!(priced.objective > free.objective);
}

/// Whichever inputs are changed within their limits, the cost does not fall.
#[test]
fn no_change_of_the_inputs_lowers_the_cost() {
    let problem = problem(0.0, Some(Peak { price: 1.0, least_kw: 0.0 }));
    let best = solve(&problem, 1e-9).expect("solved");
    let m = problem.inputs.len();
    for (round, change) in numbers(40 * best.inputs.len(), 0.3).chunks(best.inputs.len()).enumerate() {
        let moved: Vec<f64> = (best.inputs.iter().zip(change).enumerate())
            .map(|(i, (v, change))| {
                let stage = &problem.stages[i / m];
                (v + change * (i % 5 == round % 5) as u8 as f64).clamp(stage.lower[i % m], stage.upper[i % m])
            })
            .collect();
        assert!(problem.evaluate(&moved) >= best.objective - 1e-6, "round {round}");
    }
}

#[test]
fn infinite_numbers_and_empty_limits_of_programmes_are_refused() {
    let mut wrong = problem(0.0, None);
    wrong.stages[3].linear[0] = f64::NAN;
    assert!(solve(&wrong, 1e-8).is_err());
    let mut wrong = problem(0.0, None);
    wrong.stages[3].upper[0] = 0.0;
    assert!(solve(&wrong, 1e-8).is_err());
}
