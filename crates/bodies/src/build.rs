//! Conversion of a body stated in a file into the body of a model.

use barrelstack_dynamics::solid::{Ball, Barrel, Block, Bulk, Capsule, Hull, Rounded};
use barrelstack_dynamics::{
    Body, Motion, Nodes, Placed, Pose, Quaternion, Rotation3, Solid as Surface, Spatial, Twist,
    Vec3,
};

use crate::{Solid, SpatialBody};

/// One solid of a body: surface, placement in the body, and mass properties at unit density.
struct Piece {
    surface: Surface,
    offset: Vec3,
    rotation: Rotation3,
    bulk: Option<Bulk>,
}

impl SpatialBody {
    /// Builds the body in its initial state. The body frame has its origin at the center of mass and its axes along the
    /// principal axes.
    pub fn build(&self) -> Body<Spatial> {
        let pieces = pieces(&self.solid);
        let turned = turn(self.orientation);
        let (bulk, inertia, axes) = self.matter(&pieces);
        let inward = axes.matrix();
        let placed = |piece: &Piece| Placed {
            surface: piece.surface.clone(),
            offset: inward.unapply(piece.offset - bulk.center),
            rotation: inward.back().after(piece.rotation),
        };
        let surfaces: Vec<Placed<Spatial>> = pieces.iter().map(placed).collect();
        let arm = turned.matrix().apply(bulk.center);
        Body {
            name: self.name.clone(),
            motion: if self.fixed_to_ground { Motion::Prescribed } else { Motion::Free },
            mass: bulk.mass,
            inertia,
            damping: self.viscous.map(|drag| [drag.linear, drag.angular]),
            pose: Pose { position: vector(self.position) + arm, orientation: turned.after(axes) },
            twist: Twist { linear: vector(self.velocity), angular: vector(self.spin) },
            nodes: surfaces.iter().filter_map(touching).collect(),
            surfaces,
            faces: Vec::new(),
        }
    }

    /// Returns the mass and center of mass, the principal moments of inertia (kg·m²), and the orientation of the
    /// principal axes in the body.
    fn matter(&self, pieces: &[Piece]) -> (Bulk, Vec3, Quaternion) {
        let ones: Vec<Bulk> = pieces.iter().filter_map(|piece| piece.bulk).collect();
        let unit = Bulk { mass: 1.0, center: Vec3::default(), second: [Vec3::default(); 3] };
        // A half-space has no mass; only a body fixed to the ground consists of one, and its mass is never used.
        let solid = if ones.is_empty() { unit } else { Bulk::sum(ones) };
        let mass = self.mass.or_else(|| Some(self.density? * solid.mass)).unwrap_or(1.0);
        let share = mass / solid.mass;
        let second = solid.second.map(|row| row * share);
        let bulk = Bulk { mass, center: solid.center, second };
        match self.inertia {
            Some(inertia) => {
                let center = self.center_of_mass.map_or(bulk.center, vector);
                (Bulk { center, ..bulk }, vector(inertia), Quaternion::identity())
            }
            None if pieces.iter().any(|piece| piece.bulk.is_none()) => {
                (bulk, Vec3::new(1.0, 1.0, 1.0), Quaternion::identity())
            }
            None => {
                let (inertia, axes) = bulk.principal();
                (bulk, inertia, axes)
            }
        }
    }
}

fn vector([x, y, z]: [f64; 3]) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Returns the rotation by three angles (rad) about the fixed axes `x`, then `y`, then `z`.
fn turn([x, y, z]: [f64; 3]) -> Quaternion {
    let about = |x, y, z| Quaternion::turn(Vec3::new(x, y, z));
    about(0.0, 0.0, z).after(about(0.0, y, 0.0)).after(about(x, 0.0, 0.0))
}

fn pieces(solid: &Solid) -> Vec<Piece> {
    if let Solid::Compound { parts } = solid {
        let part = |part: &crate::PartSolid| {
            let (offset, rotation) = (vector(part.offset), turn(part.turn).matrix());
            let place = move |piece: Piece| Piece {
                offset,
                rotation,
                bulk: piece.bulk.map(|bulk| bulk.placed(offset, rotation)),
                ..piece
            };
            pieces(&part.solid).into_iter().map(place)
        };
        return parts.iter().flat_map(part).collect();
    }
    simple(solid)
        .map(|(surface, bulk)| Piece {
            surface,
            offset: Vec3::default(),
            rotation: Rotation3::identity(),
            bulk,
        })
        .into_iter()
        .collect()
}

/// Returns the surface of a solid, and its mass distribution at unit density, which is `None` for a half-space. Returns
/// `None` for a compound or for invalid barrel dimensions.
fn simple(solid: &Solid) -> Option<(Surface, Option<Bulk>)> {
    const ROUND: f64 = std::f64::consts::PI;
    let ball = |radius: f64| 4.0 / 3.0 * ROUND * radius * radius * radius;
    Some(match *solid {
        Solid::Ball { radius } => {
            let shape = Ball { radius };
            (Surface::Ball(shape), Some(Bulk::of_ball(&shape, ball(radius))))
        }
        Solid::Capsule { length, radius } => {
            let shape = Capsule { half_length: 0.5 * length - radius, radius };
            let volume = 2.0 * ROUND * radius * radius * shape.half_length + ball(radius);
            (Surface::Capsule(shape), Some(Bulk::of_capsule(&shape, volume)))
        }
        Solid::Block { sides, rounding } => {
            let half = vector(sides) * 0.5;
            let shape = Block { half: half - Vec3::new(rounding, rounding, rounding), rounding };
            let bulk = Bulk::of_block(half, sides[0] * sides[1] * sides[2]);
            (Surface::Block(shape), Some(bulk))
        }
        Solid::Barrel { length, bilge_diameter, head_diameter, chime_radius } => {
            let shape =
                Barrel::new(length, 0.5 * head_diameter, 0.5 * bilge_diameter, chime_radius)
                    .ok()?;
            (Surface::Barrel(shape), Some(Bulk::of_barrel(&shape, shape.volume())))
        }
        Solid::HalfSpace => (Surface::HalfSpace, None),
        Solid::Compound { .. } => return None,
    })
}

/// Returns the contact nodes of a surface. Returns `None` for a half-space or a dish, which have no nodes of their own
/// but can be touched by the nodes of other bodies.
fn touching(placed: &Placed<Spatial>) -> Option<Nodes<Spatial>> {
    let hull = match &placed.surface {
        Surface::HalfSpace | Surface::Dish(_) => return None,
        Surface::Ball(ball) => {
            let (center, radius) = (placed.offset, ball.radius);
            return Some(Nodes::Rolling { center, radius, tributary_length: 1.0 });
        }
        Surface::Capsule(capsule) => Hull::Capsule(*capsule),
        Surface::Block(block) => Hull::Block(*block),
        Surface::Barrel(barrel) => Hull::Barrel(*barrel),
    };
    let (center, rotation) = (placed.offset, placed.rotation);
    Some(Nodes::Whole(Rounded { hull, center, rotation, tributary_length: 1.0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(solid: Solid) -> SpatialBody {
        SpatialBody {
            name: "body".into(),
            kind: None,
            solid,
            mass: Some(2.0),
            density: None,
            inertia: None,
            center_of_mass: None,
            position: [0.0; 3],
            orientation: [0.0; 3],
            velocity: [0.0; 3],
            spin: [0.0; 3],
            group: None,
            fixed_to_ground: false,
            viscous: None,
        }
    }

    #[test]
    fn matter_is_that_of_the_solid() {
        let ball = body(Solid::Ball { radius: 0.5 }).build();
        assert!((ball.inertia - Vec3::new(0.2, 0.2, 0.2)).length() < 1e-15);
        let solid = Solid::Block { sides: [1.0, 2.0, 3.0], rounding: 0.01 };
        let block = SpatialBody { mass: None, density: Some(0.5), ..body(solid) }.build();
        assert_eq!(block.mass, 3.0);
        let exact = Vec3::new(13.0, 10.0, 5.0) * (3.0 / 12.0);
        assert!((block.inertia - exact).length() < 1e-14, "{:?}", block.inertia);
    }

    #[test]
    fn several_solids_are_one_body_about_their_common_center() {
        let ball = |x: f64, y: f64| crate::PartSolid {
            solid: Solid::Ball { radius: 0.1 },
            offset: [x, y, 0.0],
            turn: [0.0; 3],
        };
        let solid = Solid::Compound { parts: vec![ball(0.0, 1.0), ball(2.0, 1.0)] };
        let position = [5.0, 0.0, 0.0];
        let orientation = [0.0, 0.0, std::f64::consts::FRAC_PI_2];
        let dumbbell = SpatialBody { position, orientation, ..body(solid) }.build();
        // The center of mass (1, 1, 0) as stated, rotated by a quarter turn.
        let center = dumbbell.pose.position - Vec3::new(4.0, 1.0, 0.0);
        assert!(center.length() < 1e-15, "{center:?}");
        let own = 0.4 * 0.1 * 0.1 * 2.0;
        let exact = Vec3::new(own, own + 2.0, own + 2.0);
        assert!((dumbbell.inertia - exact).length() < 1e-14, "{:?}", dumbbell.inertia);
        assert_eq!(dumbbell.nodes.len(), 2);
    }

    #[test]
    fn turns_are_about_axes_that_stand_still() {
        // The rotation about x takes the local z axis to -y; there is no rotation about y; the rotation about z takes
        // -y to x.
        let quarter = std::f64::consts::FRAC_PI_2;
        let up = turn([quarter, 0.0, quarter]).matrix().apply(Vec3::new(0.0, 0.0, 1.0));
        assert!((up - Vec3::new(1.0, 0.0, 0.0)).length() < 1e-15, "{up:?}");
    }
}
