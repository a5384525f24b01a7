//! A world that is stepped from outside.

// shown from here
use interplay_planners::Input;
use interplay_simulation::Simulation;

/// Drives the ego of a scenario with a rule of one's own: it keeps two seconds to the vehicle ahead.
fn two_seconds(scenario: &str) -> Result<bool, Box<dyn std::error::Error>> {
    let external = "vehicle.ego.driver={ kind = \"external\" }".to_owned();
    let scenario = interplay_scenarios::load(scenario, &[interplay_scenarios::Override::Set(external)])?;
    let mut simulation = Simulation::new(&scenario)?;
    loop {
        let seen = simulation.observe("ego")?.scene;
        let ahead = seen.others.iter().filter(|other| seen.ego.shares_lane_with(other));
        let lead_m = ahead.map(|other| seen.ego.lead_of(other)).filter(|lead_m| *lead_m > 0.0);
        let allowed_mps = lead_m.min_by(f64::total_cmp).map_or(f64::INFINITY, |lead_m| 0.5 * lead_m);
        let wanted_mps = seen.goal.target.speed_mps.min(allowed_mps);
        let acceleration_mps2 = (wanted_mps - seen.ego.state.speed_mps) / seen.step_s;
        simulation.apply("ego", Input { acceleration_mps2, steering_rad: 0.0 })?;
        if simulation.step()?.is_none() {
            return Ok(simulation.finish()?.collisions.is_empty());
        }
    }
}
// shown until here

#[test]
fn a_user_defined_rule_drives_among_humans() {
    assert!(two_seconds("lane-change/front-tough").expect("a run"), "it touches no vehicle");
}
