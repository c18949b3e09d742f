//! Normal contact stress along the boundary of every barrel and rack: at rest, and its largest values until the first
//! loss of a seat and over the whole run.
//!
//! In a planar model, stress is force per length of boundary (N/m). Every contact loads both of its bodies over the
//! tributary length of its contact element. For a node, this length is half the distance to each neighbor. For a
//! contact without nodes, the tributary length is 1 cm, the spacing of the nodes of the paper's racks, so that both
//! kinds of contact are comparable. A fixed length keeps stress proportional to force, as in EN 1995-1-1, 6.1.5, for
//! timber under compression across the grain. (Hertz's half-width between an oak stave and a steel bar changes with the
//! force. It is about 1 mm, less than the deflection of a stave in bending.) On a rack, there is one value for each
//! fixed node and for each other contact element. The boundary of a barrel is divided into cells, and a contact loads
//! all cells within its tributary length.
//!
//! At rest, the stress of every point times its [length](StressEnvelope::lengths) is the contact force on this point,
//! so the sum over the boundary is the sum of the contact forces on the body.

mod follow;
mod places;

use barrelstack_dynamics::{BodyId, Vec2};

pub(crate) use follow::StressWatch;

/// Number of cells around a barrel in transverse section, each half a degree wide.
const CELLS: usize = 720;

/// A point on a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryPoint {
    /// Position (m) in the body frame.
    pub position: Vec2,
    /// Unit normal out of the body.
    pub normal: Vec2,
    /// Coordinate along the boundary: the angle (rad) from the `x` axis on a circle, `x` (m) elsewhere.
    pub coordinate: f64,
}

/// Normal contact stress along the boundary of one body.
#[derive(Clone, Debug)]
pub struct StressEnvelope {
    /// The body.
    pub body: BodyId,
    /// Points to which the stress values belong.
    pub points: Vec<BoundaryPoint>,
    /// For each point, the length (m) of the boundary that the point represents.
    ///
    /// Where the boundary is loaded at rest, this is the loaded length, so that the stress at rest multiplied by the
    /// length is the contact force.
    pub lengths: Vec<f64>,
    /// `true` if the boundary is closed, so that the last point is adjacent to the first point.
    pub closed: bool,
    /// Stress (N/m) at rest, at each point.
    pub at_rest: Vec<f64>,
    /// Largest stress (N/m) until the first loss of a seat, at each point.
    pub peak: Vec<f64>,
    /// Largest stress (N/m) over the whole run, including falls, at each point.
    pub peak_whole_run: Vec<f64>,
    /// Sum of all normal contact forces on the body.
    pub total: TotalForce,
    /// Mapping from contacts to points.
    cells: Cells,
}

/// Sum of the normal forces of all contacts of a body at one instant: the integral of the stress along its boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TotalForce {
    /// Sum of the normal forces at rest (N).
    pub at_rest: f64,
    /// Largest sum of the normal forces until the first loss of a seat (N).
    pub peak: f64,
    /// Largest sum of the normal forces over the whole run (N).
    pub peak_whole_run: f64,
}

/// Division of a boundary into the points at which stresses are recorded.
#[derive(Clone, Copy, Debug)]
enum Cells {
    /// Cells of equal angle around a circle with this radius (m).
    Around(f64),
    /// Cells of equal length in `x` along a profile with this half length (m): the cells of the upper half, followed by
    /// the cells of the lower half.
    Along(f64),
    /// One point for every fixed node of the body, and one for each of the other contact elements, at the place of its
    /// first contact.
    Nodes,
}

impl StressEnvelope {
    /// Returns `true` if the values belong to fixed nodes and other contact elements of the body, not to cells along
    /// its boundary.
    pub fn is_on_nodes(&self) -> bool {
        matches!(self.cells, Cells::Nodes)
    }

    /// Returns the sum of the normal contact forces (N) on the body at rest, which is the integral of the stress at
    /// rest along the boundary.
    pub fn force_at_rest(&self) -> f64 {
        self.at_rest.iter().zip(&self.lengths).map(|(stress, length)| stress * length).sum()
    }

    /// Returns the largest stress until the first loss of a seat, divided by the largest stress at rest; `None` without
    /// load at rest. The two stresses may occur at different points.
    pub fn amplification(&self) -> Option<f64> {
        self.largest_over_rest(&self.peak)
    }

    /// Returns the largest stress over the whole run, divided by the largest stress at rest; `None` without load at
    /// rest.
    pub fn amplification_whole_run(&self) -> Option<f64> {
        self.largest_over_rest(&self.peak_whole_run)
    }

    fn largest_over_rest(&self, peak: &[f64]) -> Option<f64> {
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let at_rest = most(&self.at_rest);
        (at_rest > 0.0).then(|| most(peak) / at_rest)
    }

    /// Returns the largest stress at each point until the first loss of a seat, averaged over the part of the boundary
    /// that is loaded at rest and divided by the average stress at rest; `None` without load at rest.
    pub fn mean_amplification(&self) -> Option<f64> {
        self.mean_over_rest(&self.peak)
    }

    /// Returns the same as [`StressEnvelope::mean_amplification`], but for the whole run.
    pub fn mean_amplification_whole_run(&self) -> Option<f64> {
        self.mean_over_rest(&self.peak_whole_run)
    }

    fn mean_over_rest(&self, peak: &[f64]) -> Option<f64> {
        let at_rest = self.force_at_rest();
        let loaded = self.loaded().map(|at| peak[at] * self.lengths[at]);
        (at_rest > 0.0).then(|| loaded.sum::<f64>() / at_rest)
    }

    /// Returns the ratio of the largest stress until the first loss of a seat to the stress at rest at the same point,
    /// averaged over the part of the boundary that is loaded at rest; `None` without load at rest.
    pub fn mean_ratio(&self) -> Option<f64> {
        let length: f64 = self.loaded().map(|at| self.lengths[at]).sum();
        let ratio = |at: usize| self.peak[at] / self.at_rest[at] * self.lengths[at];
        (length > 0.0).then(|| self.loaded().map(ratio).sum::<f64>() / length)
    }

    /// Returns the mean of the envelope divided by the mean stress at rest; `None` without load at rest.
    ///
    /// The envelope is the largest stress at each point until the first loss of a seat, averaged over the part of the
    /// boundary that is loaded at any time until then. The stress at rest is averaged over the part that is loaded at
    /// rest.
    pub fn mean_of_envelope(&self) -> Option<f64> {
        let mean = |stress: &[f64]| {
            let covered = || stress.iter().zip(&self.lengths).filter(|(stress, _)| **stress > 0.0);
            let length: f64 = covered().map(|(_, length)| length).sum();
            (length > 0.0).then(|| covered().map(|(s, length)| s * length).sum::<f64>() / length)
        };
        Some(mean(&self.peak)? / mean(&self.at_rest)?)
    }

    /// Returns the largest sum of all normal contact forces until the first loss of a seat, divided by the sum at rest;
    /// `None` without load at rest.
    pub fn total_amplification(&self) -> Option<f64> {
        (self.total.at_rest > 0.0).then(|| self.total.peak / self.total.at_rest)
    }

    /// Returns the indices of the points that are loaded at rest.
    fn loaded(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.points.len()).filter(|at| self.at_rest[*at] > 0.0)
    }
}

/// Normal contact stress along the boundaries of all barrels and racks.
#[derive(Clone, Debug, Default)]
pub struct Stresses {
    /// One envelope for every barrel and rack, in the order of the bodies.
    pub envelopes: Vec<StressEnvelope>,
    /// For every body, the index of its envelope; `None` if it has none.
    of_body: Vec<Option<usize>>,
}

impl Stresses {
    /// Returns the envelope of a body; `None` if it is neither a barrel nor a rack.
    pub fn of(&self, body: BodyId) -> Option<&StressEnvelope> {
        self.of_body.get(body).copied().flatten().map(|at| &self.envelopes[at])
    }
}
