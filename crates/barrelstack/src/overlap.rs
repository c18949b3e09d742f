//! Bodies that stand in each other before anything has moved.

use barrelstack_dynamics::shape::Surface as _;
use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::{Body, Nodes, Planar, Pose, Scratch, State, Vec2};

use crate::assemble::{AssembleError, Assembly};

/// Deepest overlap (m) of two bodies at the start that sinking under weight can explain.
const ALLOWED: f64 = 2e-3;

/// Share of the way to the center of mass by which a node is drawn into its own body.
const DRAWN: f64 = 0.05;

/// Refuses bodies that stand in each other before anything has moved.
///
/// # Errors
/// Names the two that overlap most.
pub(crate) fn check_overlap(
    assembly: &Assembly,
    state: &State<Planar>,
    scratch: &mut Scratch<Planar>,
    length_scale: f64,
) -> Result<(), AssembleError> {
    let model = &assembly.model;
    barrelstack_dynamics::evaluate(model, state, scratch);
    let contacts = scratch.contacts.iter().map(|contact| (contact.pair, contact.penetration));
    let hidden = model.pairs().iter().enumerate().map(|(index, pair)| {
        let (a, b) = (&model.bodies()[pair.contactor], &model.bodies()[pair.target]);
        (index, hidden(a, &state.poses[pair.contactor], b, &state.poses[pair.target]))
    });
    let deepest = contacts.chain(hidden).max_by(|a, b| a.1.total_cmp(&b.1));
    match deepest {
        Some((pair, depth)) if depth > ALLOWED * length_scale => {
            let pair = &model.pairs()[pair];
            Err(AssembleError::Overlap {
                first: model.bodies()[pair.contactor].name.clone(),
                second: model.bodies()[pair.target].name.clone(),
                depth,
            })
        }
        _ => Ok(()),
    }
}

/// How deep (m) a point is in two bodies whose nodes may all lie on the edges of the other, as those of
/// two blocks of one height do.
///
/// The points are the nodes of one body, drawn a little towards its center of mass; only those count
/// that are inside of their own body then, which not all are where a body is not convex.
fn hidden(a: &Body<Planar>, at: &Pose<Planar>, b: &Body<Planar>, there: &Pose<Planar>) -> f64 {
    let nodes = a.nodes.iter().filter_map(|set| match set {
        Nodes::Fixed(nodes) => Some(nodes),
        // A disk whose nodes roll meets everything where it is deepest.
        Nodes::Rolling { .. } => None,
    });
    nodes.flatten().fold(0.0, |most: f64, node| {
        let drawn = node.position * (1.0 - DRAWN);
        let point = at.position + Rotation2::new(at.orientation).apply(drawn);
        most.max(depth(a, at, point).min(depth(b, there, point)))
    })
}

/// How deep (m) a point is in a body; zero outside.
fn depth(body: &Body<Planar>, pose: &Pose<Planar>, point: Vec2) -> f64 {
    let local = Rotation2::new(pose.orientation).unapply(point - pose.position);
    let depths = body
        .surfaces
        .iter()
        .map(|placed| -placed.surface.gap(placed.rotation.unapply(local - placed.offset)).distance);
    depths.fold(0.0, f64::max)
}
