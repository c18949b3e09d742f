//! Summary of a three-dimensional run: a JSON document, which includes the directions in which bodies leave their seats
//! and barrels fall.

use barrelstack_report::described;

use super::{Devices, EnergyBalance, JointSummary, OutcomeSummary, Provenance, Unfinished};
use crate::demand::Demands;
use crate::ground::MotionSummary;
use crate::variants::{Remedy, Spread};
use crate::verify::Verification;

described! {
    /// The summary of a three-dimensional run. Lengths are in m, times in s, angles in rad; `x` is across the barrels,
    /// `y` along the barrels, `z` up. A value is null where an event did not happen or does not apply.
    #[derive(Clone, Debug)]
    pub struct SummaryInSpace {
        /// Name and version of the format of this document.
        pub schema: &'static str ["space/1"],
        /// Title of the scenario.
        pub title: String,
        /// Number of the variant that was run; 0 for the stack as stated.
        pub variant: u32,
        /// Statistics of all variants; null where no variants were run.
        pub ensemble: Option<Spread>,
        /// Number of finished runs; null if the variants were not stopped early.
        pub unfinished: Option<Unfinished>,
        /// Changes that would have kept the stack up; null if the stack stands or if no change was searched for.
        pub remedy: Option<Remedy>,
        /// Numbers of variants by the direction in which the first body leaves its seat, and numbers of fallen barrels
        /// by the direction of their displacement; null if no variants were run.
        pub directions: Option<Directions>,
        /// Outcome of the run.
        pub outcome: OutcomeInSpace,
        /// All bodies except the ground; empty where the run is invalid.
        pub bodies: Vec<BodyInSpace>,
        /// Demands on the stack until the first loss of a seat.
        pub demands: Demands,
        /// Demands on the stack over the whole run, falls included.
        pub demands_whole_run: Demands,
        /// Forces between every two bodies that pressed on each other; empty where the run is invalid.
        pub interfaces: Vec<JointSummary>,
        /// Force of every element of the devices, if there are any.
        #[serde(flatten)]
        pub devices: Devices,
        /// The energy balance; null where the numbers are no longer finite.
        pub energy: Option<EnergyBalance>,
        /// The horizontal component of the ground motion that the scenario names; its field `vertical` states whether
        /// there is a vertical component.
        pub motion: Option<MotionSummary>,
        /// The other horizontal component of the ground motion; null where the motion has only one.
        pub other_component: Option<MotionSummary>,
        /// Settings of the computation, and the amount of work that it took.
        pub run: RunInSpace,
        /// Warnings.
        pub warnings: Vec<String>,
        /// Provenance of the result.
        pub provenance: Provenance,
        /// Comparison of the run with its repeats; null if there were no repeats.
        pub verification: Option<Verification>,
    }

    /// Numbers of variants by the direction in which the first body leaves its seat, and numbers of fallen barrels by
    /// the direction of their displacement.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Directions {
        /// Number of variants in which the first body that leaves its seat moves to the right (positive x).
        pub first_right: u32,
        /// Number of variants in which the first body that leaves its seat moves to the left (negative x).
        pub first_left: u32,
        /// Number of variants in which the first body that leaves its seat moves in the direction of the barrel axes,
        /// away from the viewer (positive y).
        pub first_away: u32,
        /// Number of variants in which the first body that leaves its seat moves in the direction of the barrel axes,
        /// toward the viewer (negative y).
        pub first_near: u32,
        /// Number of fallen barrels, in all variants, whose displacement from rest is mainly to the right.
        pub debris_right: u32,
        /// Number of fallen barrels, in all variants, whose displacement from rest is mainly to the left.
        pub debris_left: u32,
        /// Number of fallen barrels, in all variants, whose displacement from rest is mainly along the barrels, away
        /// from the viewer.
        pub debris_away: u32,
        /// Number of fallen barrels, in all variants, whose displacement from rest is mainly along the barrels, toward
        /// the near side.
        pub debris_near: u32,
    }

    /// Outcome of a three-dimensional run.
    #[derive(Clone, Debug, Default)]
    pub struct OutcomeInSpace {
        /// The outcome, with the same fields as for a run in a plane.
        #[serde(flatten)]
        pub common: OutcomeSummary,
        /// Direction in which the first body left its seat.
        pub heading: Option<&'static str> ["right", "left", "away", "near"],
    }

    /// One body of a three-dimensional run.
    #[derive(Clone, Debug)]
    pub struct BodyInSpace {
        /// Name of the body.
        pub name: String,
        /// Kind of the body.
        pub kind: &'static str ["barrel", "rack", "device", "body"],
        /// Level, 1 at the bottom; 0 in a free scene.
        pub level: u32,
        /// Column, 1 for the leftmost; 0 in a free scene.
        pub column: u32,
        /// Row along the barrels, 1 for the nearest; 0 in a free scene.
        pub row: u32,
        /// Time at which the body left its seat.
        pub left_seat_at: Option<f64> as "s",
        /// Direction in which the body left its seat.
        pub left_seat_to: Option<&'static str> ["right", "left", "away", "near"],
        /// Time at which the body counts as fallen.
        pub fell_at: Option<f64> as "s",
        /// Largest drop below the position at rest.
        pub drop: f64 as "m",
        /// Largest force on the body after its fall.
        pub fall_force: Option<f64> as "N",
        /// Displacement x, y, z at the end of the run, relative to the ground and measured from the position at rest.
        pub moved: [f64; 3] as "m",
        /// Position x, y, z of the center of mass at the end of the run, relative to the initial position of the
        /// ground.
        pub position: [f64; 3] as "m",
        /// Orientation of the principal axes at the end of the run, as the quaternion w, x, y, z.
        pub orientation: [f64; 4] as "1",
        /// Velocity x, y, z of the center of mass at the end of the run, including the velocity of the ground.
        pub velocity: [f64; 3] as "m/s",
        /// Angular velocity about x, y, z at the end of the run.
        pub spin: [f64; 3] as "rad/s",
        /// Largest horizontal displacement relative to the ground before the first loss of a seat.
        pub peak_displacement: f64 as "m",
        /// Largest horizontal displacement, in any direction, relative to the supports of the body, before the first
        /// loss of a seat.
        pub peak_slip: f64 as "m",
        /// Largest displacement across the barrels, relative to the supports of the body, before the first loss of
        /// a seat.
        pub peak_slip_across: f64 as "m",
        /// Largest displacement along the barrels, relative to the supports of the body, before the first loss of a
        /// seat.
        /// It may occur at another time than the largest displacement across the barrels.
        pub peak_slip_along: f64 as "m",
        /// Largest rise above the position at rest before the first loss of a seat.
        pub peak_uplift: f64 as "m",
        /// Largest tilt before the first loss of a seat; racks only.
        pub peak_tilt: Option<f64> as "rad",
        /// Largest contact force on the body before the first loss of a seat, divided by the largest contact force at
        /// rest.
        pub stress_amplification: Option<f64> as "1",
        /// Sum of the largest contact forces on the body before the first loss of a seat, divided by the sum of the
        /// contact forces at rest.
        pub mean_stress_amplification: Option<f64> as "1",
    }

    /// Settings of the computation, and the amount of work that it took.
    #[derive(Clone, Debug)]
    pub struct RunInSpace {
        /// Integration method.
        pub method: &'static str,
        /// Time step.
        pub time_step: f64 as "s",
        /// Number of accepted steps.
        pub steps: u64,
        /// Number of force evaluations.
        pub evaluations: u64,
        /// Number of contact elements tested in all evaluations.
        pub contact_evaluations: u64,
        /// Simulated time reached.
        pub end_time: f64 as "s",
        /// Reason for the end of the run.
        pub ending: &'static str ["rest", "after-collapse", "duration", "patience", "interrupted", "broken"],
        /// Number of steps taken to find equilibrium.
        pub settle_steps: Option<u64>,
        /// Wall-clock time of the run and of all its variants.
        pub wall_seconds: Option<f64> as "s",
    }
}

impl Directions {
    /// Returns the numbers of variants by the direction of the first loss of a seat: across the barrels, and along the
    /// barrels.
    pub fn first(&self) -> [u32; 2] {
        [self.first_right + self.first_left, self.first_away + self.first_near]
    }

    /// Returns the numbers of fallen barrels, in all variants, by the main direction of their displacement from rest:
    /// across the barrels, and along the barrels.
    pub fn debris(&self) -> [u32; 2] {
        [self.debris_right + self.debris_left, self.debris_away + self.debris_near]
    }
}

impl SummaryInSpace {
    /// Returns the summary as indented JSON text.
    pub fn to_json(&self) -> String {
        // Serialization can only fail for maps with keys other than strings, and there are none.
        described::to_json(self).unwrap_or_default()
    }
}
