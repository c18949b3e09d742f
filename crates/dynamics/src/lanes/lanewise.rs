//! From things made of single numbers to the same things made of bundles, lane by lane.

use crate::body::{Body, Face, Node, Nodes, Placed, Round};
use crate::contact::{FrictionLaw, Interface, NormalLaw, Rolling, Stick, Stop};
use crate::forces::Losses;
use crate::model::Model;
use crate::real::{Mask, Real};
use crate::shape::{BarrelProfile, Circle, Cradle, Shape};
use crate::space::{Planar, Pose, Rotation2, Twist, Vec2, Wrench};
use crate::strap::Strap;

/// A thing made of bundles of numbers, into each lane of which the same thing made of single numbers
/// can be put.
///
/// What decides how much memory a thing takes and which way it is computed (the number of nodes, the
/// kind of a law) must be the same in all lanes; [`Topology`](super::Topology) compares it beforehand.
pub(crate) trait Lanewise {
    /// The thing made of single numbers.
    type Single;
    /// The same thing in every lane.
    fn in_all(single: &Self::Single) -> Self;
    /// Puts a thing into one lane.
    fn put(&mut self, lane: usize, single: &Self::Single);
}

/// Why a match on two variants has no other arm.
pub(crate) const ALIKE: &str = "things that share a bundle are of one topology";

impl<R: Real> Lanewise for R {
    type Single = f64;
    fn in_all(single: &f64) -> Self {
        Real::splat(*single)
    }
    fn put(&mut self, lane: usize, single: &f64) {
        *self = self.with_lane(lane, *single);
    }
}

impl<T: Lanewise> Lanewise for Vec<T> {
    type Single = Vec<T::Single>;
    fn in_all(single: &Self::Single) -> Self {
        single.iter().map(T::in_all).collect()
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        assert_eq!(self.len(), single.len(), "{ALIKE}");
        for (bundle, single) in self.iter_mut().zip(single) {
            bundle.put(lane, single);
        }
    }
}

impl<T: Lanewise> Lanewise for Option<T> {
    type Single = Option<T::Single>;
    fn in_all(single: &Self::Single) -> Self {
        single.as_ref().map(T::in_all)
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        match (self, single) {
            (Some(bundle), Some(single)) => bundle.put(lane, single),
            (None, None) => {}
            (Some(_), None) | (None, Some(_)) => unreachable!("{ALIKE}"),
        }
    }
}

impl<A: Lanewise, B: Lanewise> Lanewise for (A, B) {
    type Single = (A::Single, B::Single);
    fn in_all(single: &Self::Single) -> Self {
        (A::in_all(&single.0), B::in_all(&single.1))
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        self.0.put(lane, &single.0);
        self.1.put(lane, &single.1);
    }
}

impl<T: Lanewise, const N: usize> Lanewise for [T; N] {
    type Single = [T::Single; N];
    fn in_all(single: &Self::Single) -> Self {
        single.each_ref().map(T::in_all)
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        for (bundle, single) in self.iter_mut().zip(single) {
            bundle.put(lane, single);
        }
    }
}

/// For a struct whose fields are all lanewise.
macro_rules! fields {
    ($bundle:ty, $single:ty, $name:ident { $($field:ident),* }) => {
        impl<R: Real> Lanewise for $bundle {
            type Single = $single;
            fn in_all(single: &Self::Single) -> Self {
                $name { $($field: Lanewise::in_all(&single.$field)),* }
            }
            fn put(&mut self, lane: usize, single: &Self::Single) {
                $(self.$field.put(lane, &single.$field);)*
            }
        }
    };
}

/// For an enum whose variants have only lanewise fields.
macro_rules! variants {
    ($bundle:ty, $single:ty, $name:ident { $($variant:ident { $($field:ident),* }),* }) => {
        impl<R: Real> Lanewise for $bundle {
            type Single = $single;
            fn in_all(single: &Self::Single) -> Self {
                match single {
                    $($name::$variant { $($field),* } => {
                        $name::$variant { $($field: Lanewise::in_all($field)),* }
                    })*
                }
            }
            fn put(&mut self, lane: usize, single: &Self::Single) {
                match self {
                    $(Self::$variant { $($field),* } => {
                        $(let bundle = $field;
                          let $name::$variant { $field, .. } = single else {
                              unreachable!("{ALIKE}")
                          };
                          bundle.put(lane, $field);)*
                    })*
                }
            }
        }
    };
}

/// Puts truth values into one lane.
pub(crate) fn put_masks<M: Mask>(masks: &mut [M], lane: usize, single: &[bool]) {
    assert_eq!(masks.len(), single.len(), "{ALIKE}");
    for (mask, single) in masks.iter_mut().zip(single) {
        let others = *mask;
        *mask = M::from_lanes(|l| if l == lane { *single } else { others.lane(l) });
    }
}

fields!(Vec2<R>, Vec2, Vec2 { x, z });
fields!(Rotation2<R>, Rotation2, Rotation2 { cos, sin });
fields!(Pose<Planar<R>>, Pose<Planar>, Pose { position, orientation });
fields!(Twist<Planar<R>>, Twist<Planar>, Twist { linear, angular });
fields!(Wrench<Planar<R>>, Wrench<Planar>, Wrench { force, moment });
fields!(Losses<Planar<R>>, Losses<Planar>, Losses { damped, friction, viscous });
fields!(Node<Planar<R>>, Node<Planar>, Node { position, tributary_length });
fields!(Face<Planar<R>>, Face<Planar>, Face { point, outward });
fields!(Placed<Planar<R>>, Placed<Planar>, Placed { surface, offset, rotation });
fields!(Circle<R>, Circle, Circle { radius });
fields!(Rolling<R>, Rolling, Rolling { lever, spin });
fields!(Cradle<R>, Cradle, Cradle { radius, sin, cos });
fields!(
    BarrelProfile<R>,
    BarrelProfile,
    BarrelProfile { half_length, head_radius, bilge_radius, stave_radius, rounding, corner_height }
);

impl<R: Real> Lanewise for Round<Planar<R>> {
    type Single = Round<Planar>;
    fn in_all(single: &Self::Single) -> Self {
        Self {
            center: Lanewise::in_all(&single.center),
            radius: R::splat(single.radius),
            limits: Lanewise::in_all(&single.limits),
            arc_limits: Lanewise::in_all(&single.arc_limits),
            sides: Lanewise::in_all(&single.sides),
            takes_limit: single.takes_limit,
            greatest_depth: R::splat(single.greatest_depth),
            tributary_length: R::splat(single.tributary_length),
        }
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        self.center.put(lane, &single.center);
        self.radius.put(lane, &single.radius);
        self.limits.put(lane, &single.limits);
        self.arc_limits.put(lane, &single.arc_limits);
        self.sides.put(lane, &single.sides);
        self.greatest_depth.put(lane, &single.greatest_depth);
        self.tributary_length.put(lane, &single.tributary_length);
    }
}

impl<R: Real> Lanewise for Stick<Planar<R>> {
    type Single = Stick<Planar>;
    fn in_all(single: &Self::Single) -> Self {
        Self {
            displacement: Real::splat(single.displacement),
            slipping: Mask::from_lanes(|_| single.slipping),
        }
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        self.displacement.put(lane, &single.displacement);
        put_masks(std::slice::from_mut(&mut self.slipping), lane, &[single.slipping]);
    }
}

impl<R: Real> Lanewise for Shape<R> {
    type Single = Shape;
    fn in_all(single: &Shape) -> Self {
        match single {
            Shape::Circle(shape) => Self::Circle(Lanewise::in_all(shape)),
            Shape::HalfPlane(shape) => Self::HalfPlane(*shape),
            Shape::Polygon(shape) => Self::Polygon(Lanewise::in_all(shape)),
            Shape::Cradle(shape) => Self::Cradle(Lanewise::in_all(shape)),
            Shape::BarrelProfile(shape) => Self::BarrelProfile(Lanewise::in_all(shape)),
        }
    }
    fn put(&mut self, lane: usize, single: &Shape) {
        match (self, single) {
            (Self::Circle(bundle), Shape::Circle(single)) => bundle.put(lane, single),
            (Self::HalfPlane(_), Shape::HalfPlane(_)) => {}
            (Self::Polygon(bundle), Shape::Polygon(single)) => bundle.put(lane, single),
            (Self::Cradle(bundle), Shape::Cradle(single)) => bundle.put(lane, single),
            (Self::BarrelProfile(bundle), Shape::BarrelProfile(single)) => bundle.put(lane, single),
            (
                Self::Circle(_)
                | Self::HalfPlane(_)
                | Self::Polygon(_)
                | Self::Cradle(_)
                | Self::BarrelProfile(_),
                _,
            ) => unreachable!("{ALIKE}"),
        }
    }
}

impl<R: Real> Lanewise for Nodes<Planar<R>> {
    type Single = Nodes<Planar>;
    fn in_all(single: &Self::Single) -> Self {
        match single {
            Nodes::Fixed(nodes) => Self::Fixed(Lanewise::in_all(nodes)),
            Nodes::Rounds(rounds) => Self::Rounds(Lanewise::in_all(rounds)),
            Nodes::Rolling { center, radius, tributary_length } => Self::Rolling {
                center: Lanewise::in_all(center),
                radius: Lanewise::in_all(radius),
                tributary_length: Lanewise::in_all(tributary_length),
            },
        }
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        match (self, single) {
            (Self::Fixed(bundle), Nodes::Fixed(single)) => bundle.put(lane, single),
            (Self::Rounds(bundle), Nodes::Rounds(single)) => bundle.put(lane, single),
            (
                Self::Rolling { center, radius, tributary_length },
                Nodes::Rolling { center: c, radius: r, tributary_length: t },
            ) => {
                center.put(lane, c);
                radius.put(lane, r);
                tributary_length.put(lane, t);
            }
            (Self::Fixed(_) | Self::Rounds(_) | Self::Rolling { .. }, _) => unreachable!("{ALIKE}"),
        }
    }
}

variants!(FrictionLaw<R>, FrictionLaw, FrictionLaw {
    Frictionless {},
    Coulomb { static_coefficient, kinetic_coefficient, tangential_stiffness, tangential_damping },
    Regularized { coefficient, velocity }
});

impl<R: Real> Lanewise for NormalLaw<R> {
    type Single = NormalLaw;
    fn in_all(single: &NormalLaw) -> Self {
        let splat = |number: f64| R::splat(number);
        match *single {
            NormalLaw::SpeedGap { stiffness, damping } => {
                Self::SpeedGap { stiffness: splat(stiffness), damping: splat(damping) }
            }
            NormalLaw::KelvinVoigt { stiffness, damping } => {
                Self::KelvinVoigt { stiffness: splat(stiffness), damping: splat(damping) }
            }
            NormalLaw::HuntCrossley { stiffness, dissipation, exponent } => Self::HuntCrossley {
                stiffness: splat(stiffness),
                dissipation: splat(dissipation),
                exponent,
            },
            NormalLaw::Hertz { stiffness } => Self::Hertz { stiffness: splat(stiffness) },
            NormalLaw::Rebound { stiffness, restitution, speed } => Self::Rebound {
                stiffness: splat(stiffness),
                restitution: splat(restitution),
                speed: splat(speed),
            },
        }
    }
    fn put(&mut self, lane: usize, single: &NormalLaw) {
        match (self, single) {
            (
                Self::SpeedGap { stiffness, damping },
                NormalLaw::SpeedGap { stiffness: k, damping: c },
            )
            | (
                Self::KelvinVoigt { stiffness, damping },
                NormalLaw::KelvinVoigt { stiffness: k, damping: c },
            )
            | (
                Self::HuntCrossley { stiffness, dissipation: damping, .. },
                NormalLaw::HuntCrossley { stiffness: k, dissipation: c, .. },
            ) => {
                stiffness.put(lane, k);
                damping.put(lane, c);
            }
            (Self::Hertz { stiffness }, NormalLaw::Hertz { stiffness: k }) => {
                stiffness.put(lane, k);
            }
            (
                Self::Rebound { stiffness, restitution, speed },
                NormalLaw::Rebound { stiffness: k, restitution: e, speed: v },
            ) => {
                stiffness.put(lane, k);
                restitution.put(lane, e);
                speed.put(lane, v);
            }
            (
                Self::SpeedGap { .. }
                | Self::KelvinVoigt { .. }
                | Self::HuntCrossley { .. }
                | Self::Hertz { .. }
                | Self::Rebound { .. },
                _,
            ) => unreachable!("{ALIKE}"),
        }
    }
}

impl<R: Real> Lanewise for Stop<R> {
    type Single = Stop;
    fn in_all(single: &Stop) -> Self {
        Self { depth: R::splat(single.depth), law: Lanewise::in_all(&single.law) }
    }
    fn put(&mut self, lane: usize, single: &Stop) {
        self.depth.put(lane, &single.depth);
        self.law.put(lane, &single.law);
    }
}

impl<R: Real> Lanewise for Interface<Planar<R>> {
    type Single = Interface<Planar>;
    fn in_all(single: &Self::Single) -> Self {
        Self {
            name: single.name.clone(),
            normal: Lanewise::in_all(&single.normal),
            stop: Lanewise::in_all(&single.stop),
            rolling: Lanewise::in_all(&single.rolling),
            friction: Lanewise::in_all(&single.friction),
            basis: single.basis,
        }
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        self.normal.put(lane, &single.normal);
        self.stop.put(lane, &single.stop);
        self.rolling.put(lane, &single.rolling);
        self.friction.put(lane, &single.friction);
    }
}

impl<R: Real> Lanewise for Body<Planar<R>> {
    type Single = Body<Planar>;
    fn in_all(single: &Self::Single) -> Self {
        Self {
            name: single.name.clone(),
            motion: single.motion,
            mass: Lanewise::in_all(&single.mass),
            inertia: Lanewise::in_all(&single.inertia),
            damping: Lanewise::in_all(&single.damping),
            pose: Lanewise::in_all(&single.pose),
            twist: Lanewise::in_all(&single.twist),
            surfaces: Lanewise::in_all(&single.surfaces),
            nodes: Lanewise::in_all(&single.nodes),
            faces: Lanewise::in_all(&single.faces),
        }
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        self.mass.put(lane, &single.mass);
        self.inertia.put(lane, &single.inertia);
        self.damping.put(lane, &single.damping);
        self.pose.put(lane, &single.pose);
        self.twist.put(lane, &single.twist);
        self.surfaces.put(lane, &single.surfaces);
        self.nodes.put(lane, &single.nodes);
        self.faces.put(lane, &single.faces);
    }
}

impl<R: Real> Lanewise for Strap<Planar<R>> {
    type Single = Strap<Planar>;
    fn in_all(single: &Self::Single) -> Self {
        Self {
            name: single.name.clone(),
            bodies: single.bodies,
            points: Lanewise::in_all(&single.points),
            length: Lanewise::in_all(&single.length),
            stiffness: Lanewise::in_all(&single.stiffness),
            damping: Lanewise::in_all(&single.damping),
            strength: Lanewise::in_all(&single.strength),
        }
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        self.points.put(lane, &single.points);
        self.length.put(lane, &single.length);
        self.stiffness.put(lane, &single.stiffness);
        self.damping.put(lane, &single.damping);
        self.strength.put(lane, &single.strength);
    }
}

impl<R: Real> Lanewise for Model<Planar<R>> {
    type Single = Model<Planar>;
    fn in_all(single: &Self::Single) -> Self {
        Self {
            bodies: Lanewise::in_all(&single.bodies),
            interfaces: Lanewise::in_all(&single.interfaces),
            pairs: single.pairs.clone(),
            couples: single.couples.clone(),
            straps: Lanewise::in_all(&single.straps),
            gravity: Lanewise::in_all(&single.gravity),
            reach: single.reach.clone(),
        }
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        self.bodies.put(lane, &single.bodies);
        self.interfaces.put(lane, &single.interfaces);
        self.straps.put(lane, &single.straps);
        self.gravity.put(lane, &single.gravity);
        for (reach, single) in self.reach.iter_mut().zip(&single.reach) {
            // Balls that hold the body of every lane.
            *reach = reach.max(*single);
        }
    }
}
