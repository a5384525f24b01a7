//! Plans whose changes undo each other, or whose samples are one run.

#[path = "common/plans.rs"]
mod plans;

/// Each wrong plan, with the line, the column and a fragment of its error.
const WRONG: &[plans::WrongPlan] = &[
    // The same driver, stated by keys that exclude each other.
    (
        "scenario = ['lane-change/front-nice']\nstyle = ['nice', 'tough']\n[vary]\n\
         'vehicle.*.driver.safety_weight' = { log_uniform = [0.2, 100.0] }\n",
        2,
        10,
        "`vehicle.*.driver.style` is set here, and the plan varies `vehicle.*.driver.safety_weight`, which excludes it",
    ),
    (
        "scenario = ['lane-change/front-nice']\n[[style]]\nname = 'x'\nvary = { 'vehicle.*.driver.style' = ['nice', 'tough'] }\n\
         [vary]\n'vehicle.*.driver.safety_weight' = { log_uniform = [0.2, 100.0] }\n",
        6,
        19,
        "varies here, and the style `x` varies `vehicle.*.driver.style`, which excludes it",
    ),
    // One such style suffices: its rows would state weights that no driver has.
    (
        "scenario = ['lane-change/front-nice']\n[[style]]\nname = 'x'\n[[style]]\nname = 'y'\n\
         vary = { 'vehicle.*.driver' = [{ kind = 'human' }, { kind = 'human', style = 'nice' }] }\n\
         [vary]\n'vehicle.*.driver.safety_weight' = { log_uniform = [0.2, 100.0] }\n",
        8,
        19,
        "varies here, and the style `y` varies `vehicle.*.driver.style`",
    ),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\n'vehicle.front.driver.safety_weight' = [0.2, 2.0]\n\
         vehicle.front.driver.style = ['nice', 'tough']\n",
        4,
        22,
        "`vehicle.front.driver.style` varies here, and the plan varies `vehicle.front.driver.safety_weight`",
    ),
    // Settings that every style or every planner replaces, by a key, by `vehicle.*`, or by another kind of driver.
    (
        "scenario = ['lane-change/front-nice']\nset = { vehicle.front.driver.style = 'tough' }\nstyle = ['nice', 'tough']\n",
        2,
        23,
        "is set here, and the style `nice` sets `vehicle.*.driver.style`, which is laid over it",
    ),
    (
        "scenario = ['lane-change/front-nice']\nset = { 'vehicle.front.goal.speed_mps' = 1.1 }\n[[style]]\nname = 'x'\n\
         set = { 'vehicle.*.goal.speed_mps' = 1.2 }\n",
        2,
        29,
        "and the style `x` sets `vehicle.*.goal.speed_mps`, which is laid over it",
    ),
    (
        "scenario = ['lane-change/front-nice']\nset = { vehicle.ego.driver.settled_steps = 20 }\nplanner = ['idm', 'conservative']\n",
        2,
        21,
        "the planner `idm` sets `vehicle.ego.driver.kind`, of which the kind `idm` is laid over it and does not know it",
    ),
    (
        "scenario = ['lane-change/front-nice']\nset = { vehicle.front.start = { lane = 1, along_m = 2.0 } }\n[[style]]\nname = 'a'\n\
         set = { vehicle.front.start.x_m = 0.2 }\n",
        2,
        23,
        "the style `a` sets `vehicle.front.start.x_m`, which excludes it",
    ),
    (
        "scenario = ['lane-change/front-nice']\njitter = { position_m = 0.1, speed_mps = 0.1 }\nset = { horizon_steps = 20 }\n\
         planner = [{ name = 'x', set = { horizon_steps = 21 } }, { name = 'y', set = { horizon_steps = 22 } }]\n",
        3,
        9,
        "the planner `x` sets `horizon_steps`, which is laid over it",
    ),
    // A planner's kind beside a driver that it sets.
    (
        "scenario = ['lane-change/front-nice']\n\
         planner = [{ name = 'x', kind = 'conservative', set = { vehicle.ego.driver = { kind = 'idm' } } }]\n",
        2,
        33,
        "`vehicle.ego.driver.kind` is set here, and the planner `x` sets `vehicle.ego.driver.kind`",
    ),
    // A counterfactual that changes what varies would be the scenario as it is.
    (
        "scenario = ['intersection/nice']\ncounterfactuals = true\n[vary]\nvehicle.ego.driver.kind = ['idm', 'game']\n",
        4,
        20,
        "sets `vehicle.ego.driver.kind`, and what varies here is laid over it",
    ),
    // Samples in which nothing is drawn.
    ("scenario = ['lane-change/front-nice']\nsamples = 40\n", 2, 11, "its 40 samples are the same run"),
    (
        "scenario = ['lane-change/front-nice']\nsamples = 40\nplanner = ['idm', 'conservative']\n[vary]\n\
         vehicle.front.start.speed_mps = [1.0, 1.1]\n",
        2,
        11,
        "its 40 samples are the same run",
    ),
    (
        "scenario = ['lane-change/front-nice']\nsamples = 2\njitter = { position_m = 0.0, speed_mps = 0.0 }\n",
        2,
        11,
        "its 2 samples are the same run",
    ),
    (
        "scenario = ['lane-change/front-nice']\nsamples = 40\nstyle = [{ name = 'any', vary = { 'vehicle.*.start.speed_mps' = \
         { uniform = [1.0, 1.1] } } }, 'tough']\n",
        2,
        11,
        "with the style `tough` and the planner `as-written`: its 40 samples",
    ),
    (
        "scenario = ['lane-change/front-nice']\nsamples = 40\n[vary]\nvehicle.ego.sensing.speed_sd_mps = [0.1, 0.0]\n",
        2,
        11,
        "`vehicle.ego.sensing.speed_sd_mps = 0.0`: its 40 samples",
    ),
];

#[test]
fn changes_and_samples_without_effect_are_refused_at_their_place() {
    plans::all_are_refused(WRONG);
}

/// Changes with an effect in some run, and samples with a drawn value.
#[test]
fn changes_and_samples_with_an_effect_are_accepted() {
    for text in [
        "scenario = ['lane-change/front-nice']\nset = { vehicle.ego.driver.settled_steps = 20 }\nplanner = ['negotiation', 'idm']\n",
        "scenario = ['lane-change/front-nice']\nset = { 'vehicle.*.goal.speed_mps' = 1.1, 'vehicle.front.goal.speed_mps' = 1.2 }\n",
        "scenario = ['lane-change/front-nice']\nset = { vehicle.front.driver.style = 'tough' }\nstyle = ['as-written', 'nice']\n",
        "scenario = ['lane-change/front-nice']\nsamples = 3\nset = { vehicle.ego.sensing.speed_sd_mps = 0.05 }\n",
        "scenario = ['lane-change/front-nice']\nsamples = 3\nset = { vehicle.ego.sensing.drop_rate = 0.05 }\n",
        "scenario = ['lane-change/front-nice']\nsamples = 3\nset = { start_jitter.speed_mps = 0.05 }\n",
        "scenario = ['lane-change/front-nice']\nsamples = 3\nsampling = 'random'\n[vary]\nhorizon_steps = [20, 25]\n",
        "scenario = ['building/tower']\nsamples = 3\n",
        "scenario = ['lane-change/front-nice']\nset = { horizon_steps = 20 }\n[[style]]\nname = 'a'\n[[style]]\nname = 'b'\n\
         vary = { horizon_steps = [25, 30] }\n",
        "scenario = ['lane-change/front-nice']\nset = { real_time.plan_budget_ms = 10 }\nplanner = ['as-written', { name = 'late', \
         set = { real_time.deadline = 'enforced' } }]\n",
        "scenario = ['lane-change/front-nice']\nset = { vehicle.front.start = { heading_rad = 0.0 } }\n[vary]\n\
         vehicle.front.start.speed_mps = [1.0, 1.1]\n",
        "scenario = ['lane-change/front-nice']\nseed = 4\nsamples = 3\njitter = { position_m = 0.1, speed_mps = 0.1 }\n",
    ] {
        let plan = plans::read(text);
        assert!(plan.is_ok(), "{text}: {:?}", plan.err().map(|error| error.faults().to_vec()));
    }
}
