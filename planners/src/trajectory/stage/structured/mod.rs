//! A primal-dual interior point for stage problems, with a Riccati factorisation that sees the bicycle.
//!
//! # Elimination
//!
//! Let `z` hold all deviations. Every inequality `c + g·z + σ − s = 0` has a slack `s ≥ 0` with multiplier `λ ≥ 0`; a soft
//! row also has a violation `σ ≥ 0` with multiplier `ν ≥ 0` and the cost `ℓ σ + ½ q σ²` (`ℓ` the linear weight, `q` twice
//! the quadratic one); boxes and hard rows have `σ = 0`. Newton's method on
//!
//! ```text
//! ∇J(z) − Σ g λ + dynamics = 0,   ℓ + q σ − λ − ν = 0,   s λ = μ,   σ ν = μ
//! ```
//!
//! with `d₁ = λ/s`, `d₂ = ν/σ`, `D = q + d₁ + d₂`, targets `η₁ = t₁/s − d₁ r` (`r = c + g·z + σ − s`), `η₂ = t₂/σ` and
//! `e = η₁ + η₂ − ℓ − q σ` gives, in this order:
//!
//! ```text
//! Δσ = (e − d₁ g·Δz)/D
//! λ⁺ = (η₁ − d₁ e/D) − ω g·Δz,     ω = d₁ (q + d₂)/D          (never as d₁ − d₁²/D, which cancels)
//! Δs = g·Δz + Δσ + r
//! ```
//!
//! so a soft row costs no more than a hard one: it adds `ω g gᵀ` to the Hessian and `−(η₁ − d₁ e/D) g` to the gradient. A
//! row with `ℓ = 0` needs no `σ ≥ 0` (its optimum has it anyway) and takes `d₂ = ν = 0`. What remains is an unconstrained
//! problem over the dynamics, solved by [`riccati`]. Predictor and corrector (Mehrotra) share its factorisation.
//!
//! # Rows over a whole trajectory
//!
//! `σ − value − Σ b·(p, v) − Σ β‖p‖² ≥ 0` has the gradient `−v`, `v_k = b_k + 2 β_k p_k`, at the current point and adds
//! `2 λ β` to the Hessian of every position and `ω v vᵀ` to all of it. The second is of rank one: with `y = H⁻¹v`, one more
//! Riccati solve, Sherman and Morrison give `Δz = Δz₀ − ω (v·Δz₀)/(1 + ω v·y) y`. With several rows this is done for one
//! after the other, `H` being what the rows before have made of it.
//!
//! # Start and end
//!
//! Where nothing is known, a violated soft row begins with `λ = ν = ℓ/2`, every other soft row with `ν = ℓ`, so that `ℓ + q σ − λ − ν`
//! is small from the beginning, and every other number with the same `μ` and slack.
//! With the multipliers `λ` of a neighbouring problem every product starts at the same small `μ`: `s = μ/λ` where the row was
//! active, `λ = μ/s` where it was not; a violation follows from `λ` by stationarity, `σ = (λ − ℓ)₊/q`, `ν = ℓ + q σ − λ`. Rows
//! that the expected deviations cannot reach are left out; the solution without them is the solution if it satisfies them,
//! else it is sought again with all. The end is where `μ` and every residual are below the tolerance and the derivative of
//! the Lagrangian over the inputs, computed anew, vanishes: with large weights multipliers lose digits, which a further step
//! (next to nothing in `z`) restores.
//!
//! # Cost per iteration
//!
//! One factorisation and two back-substitutions (one more where refined, and one for each row over a trajectory). Per stage
//! and pair of vehicles the factorisation takes some 200 multiplications for `AᵀPA`, `BᵀPA`, `BᵀPB` (the bicycle's `A` has
//! five entries beside its diagonal, its `B` four); `L⁻¹F_wz` and `VᵀV` of `M` vehicles cost `(2M)²·3M` and some
//! `2M·18M(M + 1)` more. `tests/instructions/count.sh` counts what becomes of that.

mod assemble;
mod cholesky;
mod columns;
mod interior;
mod memory;
mod refine;
mod riccati;
mod rows;
mod trajectory_row;
mod write;

pub use interior::Structured;
