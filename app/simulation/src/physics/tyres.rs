//! Tyres: the single-track model with forces limited by friction.
//!
//! Both wheels of an axle are combined into one in the middle, at `ℓ_f = L_f` and `ℓ_r = −L_r` along the vehicle; the front one is
//! steered by `δ`. With the velocity `(v_x, v_y, r)` in the vehicle's frame a wheel rolls and slips at
//!
//! ```text
//! w =  cos δ v_x + sin δ (v_y + ℓ r),      n = −sin δ v_x + cos δ (v_y + ℓ r),      slip angle  −n/|w|
//! ```
//!
//! and transmits, with the load `F_z` of its axle (static: `m g L_r/L` and `m g L_f/L`),
//!
//! ```text
//! along it  F_x = F_z a/g              if a > 0; else a brake against w, no stronger than what stops the wheel
//! across    F_y = −c F_z n/|w|         cornering stiffness c, as a share of the load
//! both      F_x² + F_y² ≤ (μ F_z)²     the friction circle: F_x first, then what is left for F_y
//! ```
//!
//! As a wheel rolls more slowly, `n ↦ F_y` becomes arbitrarily stiff. So the lateral forces are those at the *end* of the
//! sub-step `h` (implicit Euler), as impulses `p = h F_y`:
//!
//! ```text
//! (diag(|w|/(h c F_z)) + J M⁻¹ Jᵀ) p = −n,      |p_i| ≤ h √((μ F_z)² − F_x²)
//! ```
//!
//! with the rows `J` of both `n`. No term is divided by a speed. At `w = 0` this is static friction: no slip as long as
//! friction holds, which is the kinematic bicycle.

use interplay_planners::Body;
use interplay_scenarios::Dynamic;

/// Acceleration of gravity \[m/s²\].
pub(super) const GRAVITY_MPS2: f64 = 9.81;
/// Number of Gauss-Seidel sweeps over the two lateral impulses; each reduces the error to a fifth or less.
const GAUSS_SEIDEL_SWEEPS: usize = 12;

/// A velocity or an impulse in the vehicle's frame: along, across, and about its mass centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Planar {
    /// Component along the vehicle \[m/s or N s\].
    pub forward: f64,
    /// Component to the left of the vehicle \[m/s or N s\].
    pub left: f64,
    /// Component about the vertical axis, counter-clockwise \[rad/s or N m s\].
    pub yaw: f64,
}

impl Planar {
    /// Inner product: of a direction and a velocity, the velocity in that direction.
    fn dot(&self, other: &Planar) -> f64 {
        self.forward * other.forward + self.left * other.left + self.yaw * other.yaw
    }

    /// `self + share · other`.
    fn plus(&self, share: f64, other: &Planar) -> Planar {
        Planar {
            forward: self.forward + share * other.forward,
            left: self.left + share * other.left,
            yaw: self.yaw + share * other.yaw,
        }
    }
}

/// Mass and tyres of a vehicle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chassis {
    /// Mass \[kg\].
    pub mass_kg: f64,
    /// Moment of inertia about the mass centre \[kg m²\].
    pub inertia_kgm2: f64,
    /// Positions of the axles along the vehicle, front and rear \[m\].
    axles_m: [f64; 2],
    /// Share of the mass that each axle carries.
    shares: [f64; 2],
    /// Cornering stiffness of each axle as a share of its load \[1/rad\].
    stiffness_per_rad: [f64; 2],
    friction: f64,
}

impl Chassis {
    /// A vehicle of this mass, spread evenly over its footprint.
    pub fn new(body: &Body, mass_kg: f64, plant: &Dynamic) -> Self {
        let (length, width, wheelbase) = (body.front_m + body.rear_m, body.width_m, body.wheelbase_m());
        Chassis {
            mass_kg,
            inertia_kgm2: mass_kg * (length * length + width * width) / 12.0,
            axles_m: [body.front_axle_m, -body.rear_axle_m],
            shares: [body.rear_axle_m / wheelbase, body.front_axle_m / wheelbase],
            stiffness_per_rad: [plant.front_stiffness_per_rad, plant.rear_stiffness_per_rad],
            friction: plant.friction,
        }
    }

    /// The rolling and slipping directions of the wheels, as rows over the velocity: front and rear.
    fn wheels(&self, steering_rad: f64) -> [[Planar; 2]; 2] {
        let (sin, cos) = libm::sincos(steering_rad);
        let wheel = |at_m: f64, sin: f64, cos: f64| {
            let roll = Planar { forward: cos, left: sin, yaw: at_m * sin };
            [roll, Planar { forward: -sin, left: cos, yaw: at_m * cos }]
        };
        [wheel(self.axles_m[0], sin, cos), wheel(self.axles_m[1], 0.0, 1.0)]
    }

    /// The change of velocity that an impulse causes.
    pub fn response(&self, impulse: &Planar) -> Planar {
        let Planar { forward, left, yaw } = *impulse;
        Planar { forward: forward / self.mass_kg, left: left / self.mass_kg, yaw: yaw / self.inertia_kgm2 }
    }

    /// The impulse of the tyres during a sub-step that begins with `velocity`, with the actuators at `acceleration_mps2` and
    /// `steering_rad` \[N s, N m s\].
    pub fn impulse(&self, velocity: &Planar, acceleration_mps2: f64, steering_rad: f64, step_s: f64) -> Planar {
        let wheels = self.wheels(steering_rad);
        let mut total = Planar::default();
        let (mut most_ns, mut roll_mps) = ([0.0; 2], [0.0; 2]);
        for (i, [roll, _]) in wheels.iter().enumerate() {
            let mass_kg = self.shares[i] * self.mass_kg;
            let grip_ns = self.friction * mass_kg * GRAVITY_MPS2 * step_s;
            roll_mps[i] = roll.dot(velocity);
            let wanted_ns = if acceleration_mps2 > 0.0 {
                mass_kg * acceleration_mps2 * step_s
            } else {
                let stops_ns = -mass_kg * roll_mps[i];
                stops_ns.clamp(mass_kg * acceleration_mps2 * step_s, -mass_kg * acceleration_mps2 * step_s)
            };
            let along_ns = wanted_ns.clamp(-grip_ns, grip_ns);
            most_ns[i] = (grip_ns * grip_ns - along_ns * along_ns).max(0.0).sqrt();
            total = total.plus(along_ns, roll);
        }
        let free = velocity.plus(1.0, &self.response(&total));
        let slips = [wheels[0][1], wheels[1][1]];
        let compliance = std::array::from_fn(|i| {
            let load_n = self.shares[i] * self.mass_kg * GRAVITY_MPS2;
            roll_mps[i].abs() / (step_s * self.stiffness_per_rad[i] * load_n)
        });
        let lateral_ns = self.lateral(&free, &slips, compliance, most_ns);
        total.plus(lateral_ns[0], &slips[0]).plus(lateral_ns[1], &slips[1])
    }

    /// The two lateral impulses, by projected Gauss-Seidel.
    fn lateral(&self, free: &Planar, slips: &[Planar; 2], compliance: [f64; 2], most_ns: [f64; 2]) -> [f64; 2] {
        let responses = [self.response(&slips[0]), self.response(&slips[1])];
        let mut impulses_ns = [0.0; 2];
        for _ in 0..GAUSS_SEIDEL_SWEEPS {
            for i in 0..2 {
                let other = impulses_ns[1 - i] * slips[i].dot(&responses[1 - i]);
                let wanted = -(slips[i].dot(free) + other) / (slips[i].dot(&responses[i]) + compliance[i]);
                impulses_ns[i] = wanted.clamp(-most_ns[i], most_ns[i]);
            }
        }
        impulses_ns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUB_STEP_S: f64 = 1e-3;

    fn chassis() -> Chassis {
        Chassis::new(&Body::default(), 14.0, &Dynamic { friction: 0.7, ..Dynamic::default() })
    }

    /// Checks velocities in all directions, fast and slow, with all inputs of the actuators.
    fn for_all(check: impl Fn(Planar, f64, f64)) {
        for forward in [-2.0, -0.01, 0.0, 1e-9, 0.3, 4.0] {
            for left in [-1.0, 0.0, 0.02] {
                for yaw in [-8.0, 0.0, 0.5] {
                    for steering_rad in [-1.0, 0.0, 0.2] {
                        for acceleration_mps2 in [-20.0, -1.0, 0.0, 3.0] {
                            check(Planar { forward, left, yaw }, acceleration_mps2, steering_rad);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn tyres_transmit_no_more_than_friction_allows() {
        let (chassis, most) = (chassis(), 0.7 * 14.0 * GRAVITY_MPS2 * SUB_STEP_S);
        for_all(|velocity, acceleration, steering| {
            let Planar { forward, left, yaw } = chassis.impulse(&velocity, acceleration, steering, SUB_STEP_S);
            assert!((forward * forward + left * left).sqrt() <= most * (1.0 + 1e-12), "{velocity:?}");
            assert!(yaw.abs() <= 0.21 * most, "{velocity:?}: no arm is longer than {yaw}");
        });
    }

    /// Tyres that do not drive reduce the kinetic energy or keep it.
    #[test]
    fn without_drive_the_kinetic_energy_never_grows() {
        let chassis = chassis();
        let energy = |v: &Planar| {
            chassis.mass_kg * (v.forward * v.forward + v.left * v.left) + chassis.inertia_kgm2 * v.yaw * v.yaw
        };
        for_all(|velocity, acceleration, steering| {
            let impulse = chassis.impulse(&velocity, acceleration.min(0.0), steering, SUB_STEP_S);
            let after = velocity.plus(1.0, &chassis.response(&impulse));
            assert!(energy(&after) <= energy(&velocity) * (1.0 + 1e-9) + 1e-15, "{velocity:?} {after:?}");
        });
    }

    /// Sliding sideways at standstill, both axles stop at once if friction suffices.
    #[test]
    fn a_wheel_at_standstill_does_not_slip() {
        let (chassis, velocity) = (chassis(), Planar { forward: 0.0, left: 1e-3, yaw: 4e-3 });
        let after = velocity.plus(1.0, &chassis.response(&chassis.impulse(&velocity, 0.0, 0.0, SUB_STEP_S)));
        assert!(after.left.abs() < 1e-9 && after.yaw.abs() < 1e-8, "{after:?}");
    }
}
