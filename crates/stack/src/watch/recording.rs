//! Recording of frames of the motion, and of histories of displacements, forces and energies, at given rates.

use barrelstack_dynamics::forces::{contact_force, tributary_length};
use barrelstack_dynamics::{EnergyLedger, Model, Planar, Pose, Scratch, State, Vec2};

use barrelstack_columns::column::column_name;

use crate::assemble::{Assembly, PartKind};
use crate::ground::Ground;
use crate::watch::joints::{Joint, Joints};

/// History of a quantity at the sample times of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name, such as "`B1.1_displacement_x`".
    pub name: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// One value for every sample.
    pub values: Vec<f64>,
}

/// Poses of all bodies at the times of the frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frames {
    /// Times (s).
    pub times: Vec<f64>,
    /// For every frame and body: `x` (m), `z` (m), angle (rad), in the inertial frame.
    pub poses: Vec<Vec<[f64; 3]>>,
    /// For every frame, contact forces: `x` (m) and `z` (m) of the point, and both components of the force (N) on the
    /// contactor.
    pub forces: Vec<Vec<[f64; 4]>>,
    /// For every frame and body, the largest normal stress (N/m) of its contacts; zero without contacts.
    pub stresses: Vec<Vec<f64>>,
}

impl Frames {
    /// Returns the poses of all bodies for each frame.
    pub fn all_poses(&self) -> impl Iterator<Item = Vec<Pose<Planar>>> {
        let pose = |[x, z, orientation]: &[f64; 3]| Pose {
            position: Vec2::new(*x, *z),
            orientation: *orientation,
        };
        self.poses.iter().map(move |frame| frame.iter().map(pose).collect())
    }
}

/// History of the force between two bodies of a stack. One of the bodies supports the other by design, or the two have
/// touched during the run.
#[derive(Clone, Debug, PartialEq)]
pub struct JointForces {
    /// The bodies, with the force at rest and the largest forces in any step.
    pub joint: Joint,
    /// Name of the joint, such as "R1 on ground".
    pub name: String,
    /// Vertical force (N) on the upper body at the sample times.
    pub vertical: Vec<f64>,
    /// Horizontal force (N) on the upper body at the sample times.
    pub horizontal: Vec<f64>,
}

/// Number of recorded histories of the ground motion: acceleration, velocity and displacement, each horizontal and
/// vertical.
const GROUND: usize = 6;

/// Number of recorded histories of a body: two displacements and a rotation.
const BODY: usize = 3;

/// Recorded data of a run.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Frames of the motion.
    pub frames: Frames,
    /// Sample times (s), common to all channels.
    pub times: Vec<f64>,
    /// Histories of the ground motion, the displacements and the energies.
    pub channels: Vec<Channel>,
    /// Forces between bodies, beginning with the pairs in which one body supports the other by design.
    pub joints: Vec<JointForces>,
    frame_rate: f64,
    history_rate: f64,
    rest: Vec<Vec2>,
    /// Observer of the current and largest forces between bodies, from which `joints` is filled.
    forces: Joints,
    started: bool,
}

impl Recording {
    /// Returns the observer of the forces between bodies, which holds the current force, the force at rest and the
    /// largest forces of each pair of bodies.
    pub fn forces(&self) -> &Joints {
        &self.forces
    }

    /// Creates a recording from the state at rest; the rates (Hz) are the sampling rates of frames and of histories.
    pub(super) fn new(
        assembly: &Assembly,
        state: &State<Planar>,
        (frame_rate, history_rate): (f64, f64),
    ) -> Self {
        let mut names: Vec<(String, &'static str)> = ["x", "z"]
            .iter()
            .flat_map(|axis| {
                [
                    (format!("ground_acceleration_{axis}"), "m/s2"),
                    (format!("ground_velocity_{axis}"), "m/s"),
                    (format!("ground_displacement_{axis}"), "m"),
                ]
            })
            .collect();
        for part in assembly.parts.iter().filter(|p| p.kind != PartKind::Ground) {
            let name = column_name(&part.name);
            names.push((format!("{name}_displacement_x"), "m"));
            names.push((format!("{name}_displacement_z"), "m"));
            names.push((format!("{name}_rotation"), "rad"));
        }
        for energy in ENERGIES {
            names.push((column_name(&format!("energy {energy}")), "J"));
        }
        let channels = names
            .into_iter()
            .map(|(name, unit)| Channel { name, unit, values: Vec::new() })
            .collect();
        let ground = state.poses[Assembly::GROUND].position;
        let forces = Joints::new(assembly);
        let named = |joint: &Joint| JointForces::new(assembly, joint, 0);
        Self {
            frames: Frames::default(),
            times: Vec::new(),
            channels,
            frame_rate,
            history_rate,
            rest: state.poses.iter().map(|p| p.position - ground).collect(),
            joints: forces.joints.iter().map(named).collect(),
            forces,
            started: false,
        }
    }

    /// Returns the number of values in one sample of the histories, including its time.
    pub(crate) fn histories(assembly: &Assembly) -> usize {
        1 + GROUND
            + BODY * assembly.parts.len()
            + ENERGIES.len()
            + 2 * Joints::new(assembly).joints.len()
    }

    /// Returns the channel with the given name. Spaces in the name count as underscores, as in `B4.1 displacement x`.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        let name = column_name(name);
        self.channels.iter().find(|channel| channel.name == name)
    }

    /// Returns the history of the displacement (m) along `x` of the body with the given name, relative to the ground
    /// and to its position at rest. Returns `None` if there is no such body.
    pub fn displacement(&self, body: &str) -> Option<&Channel> {
        self.channel(&format!("{body} displacement x"))
    }

    pub(super) fn observe(
        &mut self,
        assembly: &Assembly,
        ground: &Ground,
        standing: bool,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
        energy: &EnergyLedger<Planar>,
    ) {
        if self.started {
            self.forces.observe(state.time, standing, scratch);
        } else {
            self.forces.start(state.time, scratch);
        }
        // Pairs of bodies that first touched in this step get zeros for earlier samples.
        let met = self.forces.joints.iter().skip(self.joints.len());
        self.joints.extend(met.map(|joint| JointForces::new(assembly, joint, self.times.len())));
        self.started = true;
        // The tolerance covers rounding errors of the time.
        let due = |taken: usize, rate: f64| state.time * rate >= taken as f64 - 1e-6;
        if due(self.frames.times.len(), self.frame_rate) {
            self.take_frame(&assembly.model, state, scratch);
        }
        if due(self.times.len(), self.history_rate) {
            self.take_sample(assembly, ground, state, energy);
        }
    }

    fn take_frame(
        &mut self,
        model: &Model<Planar>,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
    ) {
        self.frames.times.push(state.time);
        self.frames.poses.push(
            state.poses.iter().map(|p| [p.position.x, p.position.z, p.orientation]).collect(),
        );
        // Every pair has one arrow: the sum of its contact forces, at their center of pressure.
        let mut forces: Vec<[f64; 4]> = Vec::new();
        let mut weight = 0.0;
        let mut last = usize::MAX;
        let mut stresses = vec![0.0_f64; state.poses.len()];
        for contact in &scratch.contacts {
            let pair = model.pair(contact.pair);
            let stress =
                contact.normal_force / tributary_length(model, &pair, contact.node as usize);
            for body in [pair.contactor, pair.target] {
                stresses[body] = stresses[body].max(stress);
            }
            let (force, point) = contact_force(model, state, scratch, contact);
            if contact.pair != last {
                forces.push([0.0; 4]);
                (weight, last) = (0.0, contact.pair);
            }
            if let Some(arrow) = forces.last_mut() {
                let total = weight + contact.normal_force;
                if total > 0.0 {
                    let share = contact.normal_force / total;
                    arrow[0] += (point.x - arrow[0]) * share;
                    arrow[1] += (point.z - arrow[1]) * share;
                }
                weight = total;
                arrow[2] += force.x;
                arrow[3] += force.z;
            }
        }
        self.frames.forces.push(forces);
        self.frames.stresses.push(stresses);
    }

    fn take_sample(
        &mut self,
        assembly: &Assembly,
        ground: &Ground,
        state: &State<Planar>,
        energy: &EnergyLedger<Planar>,
    ) {
        self.times.push(state.time);
        let mut values: Vec<f64> = Vec::with_capacity(self.channels.len());
        let motion = ground.motion.as_ref();
        let x = motion.map(|m| m.horizontal.at(state.time)).unwrap_or_default();
        let z =
            motion.and_then(|m| m.vertical.as_ref()).map(|v| v.at(state.time)).unwrap_or_default();
        for k in [x, z] {
            values.extend([k.acceleration, k.velocity, k.displacement]);
        }
        let carried = state.poses[Assembly::GROUND].position;
        for (i, part) in assembly.parts.iter().enumerate() {
            if part.kind != PartKind::Ground {
                let moved = state.poses[i].position - carried - self.rest[i];
                values.extend([moved.x, moved.z, state.poses[i].orientation]);
            }
        }
        let balance = energy.summary(0);
        values.extend([
            balance.kinetic,
            balance.potential,
            balance.elastic,
            balance.stick,
            balance.damped,
            balance.friction,
            balance.viscous,
            balance.ground_work,
            balance.residual,
        ]);
        for (channel, value) in self.channels.iter_mut().zip(values) {
            channel.values.push(value);
        }
        for (history, joint) in self.joints.iter_mut().zip(&self.forces.joints) {
            history.vertical.push(joint.force.z);
            history.horizontal.push(joint.force.x);
        }
    }

    /// Ends the recording: stores the largest forces of the run, and sorts the joints in the order of
    /// [`Joints::listed`].
    pub(crate) fn finish(&mut self) {
        for (history, joint) in self.joints.iter_mut().zip(&self.forces.joints) {
            history.joint = joint.clone();
        }
        self.joints
            .sort_by_key(|JointForces { joint, .. }| (!joint.by_design, joint.upper, joint.lower));
    }
}

impl JointForces {
    /// Creates the history of a joint, with zero forces in all samples so far.
    fn new(assembly: &Assembly, joint: &Joint, samples: usize) -> Self {
        let none = vec![0.0; samples];
        let name = joint.name(assembly);
        Self { joint: joint.clone(), name, vertical: none.clone(), horizontal: none }
    }
}

/// Names of the recorded energies, in order.
const ENERGIES: [&str; 9] = [
    "kinetic",
    "potential",
    "elastic",
    "stick",
    "damped",
    "friction",
    "viscous",
    "ground work",
    "residual",
];
