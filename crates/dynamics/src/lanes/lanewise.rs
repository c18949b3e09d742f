//! Conversion, lane by lane, between values made of scalars and values made of bundles.

use crate::body::{Body, Face, Inert, Motion, Node, Nodes, Placed, Round};
use crate::contact::{Basis, Exponent, FrictionLaw, Interface, NormalLaw, Rolling, Stick, Stop};
use crate::forces::Losses;
use crate::model::{Fast, Model, Substepping};
use crate::real::{Mask, Real};
use crate::shape::{BarrelProfile, Circle, Cradle, HalfPlane, NoWhole, Shape};
use crate::solid::{Ball, Barrel, Block, Capsule, Dish, Hull, Rounded, Solid};
use crate::space::{Pose, Quaternion, Rotation2, Rotation3, Space, Twist, Vec2, Vec3, Wrench};

/// A value made of bundles; each of its lanes is a value of the corresponding type made of scalars.
///
/// Everything that determines memory layout and control flow, such as the number of nodes or the kind of a contact law,
/// must be equal in all lanes; [`Topology`](super::Topology) compares these properties beforehand.
/// [`lanewise!`](crate::lanewise) implements this trait for structs and enums from the names of their fields.
pub trait Lanewise {
    /// The corresponding type made of scalars: the value in one lane.
    type Single;
    /// Returns a value that equals `single` in every lane.
    fn in_all(single: &Self::Single) -> Self;
    /// Sets the value of one lane.
    fn put(&mut self, lane: usize, single: &Self::Single);
    /// Returns the value of one lane.
    fn of_lane(&self, lane: usize) -> Self::Single;
}

/// Panic message for values of different topology in one bundle.
#[doc(hidden)]
pub const ALIKE: &str = "all values in a bundle must have the same topology";

impl<R: Real> Lanewise for R {
    type Single = f64;
    fn in_all(single: &f64) -> Self {
        Real::splat(*single)
    }
    fn put(&mut self, lane: usize, single: &f64) {
        *self = self.with_lane(lane, *single);
    }
    fn of_lane(&self, lane: usize) -> f64 {
        self.lane(lane)
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
    fn of_lane(&self, lane: usize) -> Self::Single {
        self.iter().map(|bundle| bundle.of_lane(lane)).collect()
    }
}

impl<T: Lanewise> Lanewise for Option<T> {
    type Single = Option<T::Single>;
    fn in_all(single: &Self::Single) -> Self {
        single.as_ref().map(T::in_all)
    }
    fn put(&mut self, lane: usize, single: &Self::Single) {
        assert_eq!(self.is_some(), single.is_some(), "{ALIKE}");
        if let (Some(bundle), Some(single)) = (self, single) {
            bundle.put(lane, single);
        }
    }
    fn of_lane(&self, lane: usize) -> Self::Single {
        self.as_ref().map(|bundle| bundle.of_lane(lane))
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
    fn of_lane(&self, lane: usize) -> Self::Single {
        (self.0.of_lane(lane), self.1.of_lane(lane))
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
    fn of_lane(&self, lane: usize) -> Self::Single {
        self.each_ref().map(|bundle| bundle.of_lane(lane))
    }
}

/// One value of any type for each lane, for data that is not used in arithmetic. A single run has one lane.
#[derive(Clone, Debug, PartialEq)]
pub struct PerLane<T>(Vec<T>);

impl<T: Clone> PerLane<T> {
    /// Creates a value with one lane, for a single run.
    pub fn single(value: T) -> Self {
        Self(vec![value])
    }
}

impl<T> std::ops::Index<usize> for PerLane<T> {
    type Output = T;
    fn index(&self, lane: usize) -> &T {
        &self.0[lane]
    }
}

impl<T> std::ops::IndexMut<usize> for PerLane<T> {
    fn index_mut(&mut self, lane: usize) -> &mut T {
        &mut self.0[lane]
    }
}

impl<T: Clone> Lanewise for PerLane<T> {
    type Single = Self;
    fn in_all(single: &Self) -> Self {
        Self(vec![single[0].clone(); super::MOST_LANES])
    }
    fn put(&mut self, lane: usize, single: &Self) {
        self[lane] = single[0].clone();
    }
    fn of_lane(&self, lane: usize) -> Self {
        Self::single(self[lane].clone())
    }
}

/// Implements [`Lanewise`] from the names of the fields of a type:
///
/// - `struct Name<R> { a, b }` for structs that are generic over a scalar, and `struct Name<S> { a, b }` for structs
///   that are generic over a space; all fields are lanewise, except those after `masks`, which are masks;
/// - `enum Name<R> { One { a, b }, Two(a), Three }` for enums; the variant is part of the topology;
/// - `same Name, Other;` for types whose values are equal in all lanes.
#[macro_export]
macro_rules! lanewise {
    (struct $name:ident<R> $($rest:tt)*) => {
        $crate::lanewise!(@fields (R: $crate::real::Real) $name, ($name<R>), ($name<f64>), $($rest)*);
    };
    (struct $name:ident<S> $($rest:tt)*) => {
        $crate::lanewise!(@fields (S: $crate::Space) $name, ($name<S>), ($name<S::Single>), $($rest)*);
    };
    (enum $name:ident<R> $($rest:tt)*) => {
        $crate::lanewise!(@variants (R: $crate::real::Real) $name, ($name<R>), ($name<f64>), $($rest)*);
    };
    (enum $name:ident<S> $($rest:tt)*) => {
        $crate::lanewise!(@variants (S: $crate::Space) $name, ($name<S>), ($name<S::Single>), $($rest)*);
    };
    (same $($name:ty),*) => {$(
        impl $crate::lanes::Lanewise for $name {
            type Single = Self;
            fn in_all(single: &Self) -> Self {
                single.clone()
            }
            fn put(&mut self, _: usize, _: &Self) {}
            fn of_lane(&self, _: usize) -> Self {
                self.clone()
            }
        }
    )*};
    (
        @fields ($param:ident: $bound:path) $name:ident, ($bundle:ty), ($single:ty),
        { $($field:ident),* $(,)? } $(masks { $($mask:ident),* })?
    ) => {
        impl<$param: $bound> $crate::lanes::Lanewise for $bundle {
            type Single = $single;
            fn in_all(single: &Self::Single) -> Self {
                $name {
                    $($field: $crate::lanes::Lanewise::in_all(&single.$field),)*
                    $($($mask: $crate::real::Mask::from_lanes(|_| single.$mask),)*)?
                }
            }
            fn put(&mut self, lane: usize, single: &Self::Single) {
                $($crate::lanes::Lanewise::put(&mut self.$field, lane, &single.$field);)*
                $($($crate::lanes::put_truth(&mut self.$mask, lane, single.$mask);)*)?
            }
            fn of_lane(&self, lane: usize) -> Self::Single {
                $name {
                    $($field: $crate::lanes::Lanewise::of_lane(&self.$field, lane),)*
                    $($($mask: $crate::real::Mask::lane(self.$mask, lane),)*)?
                }
            }
        }
    };
    (
        @variants ($param:ident: $bound:path) $name:ident, ($bundle:ty), ($single:ty),
        { $($variant:ident $({ $($field:ident),* })? $(($inner:ident))?),* $(,)? }
    ) => {
        #[allow(unreachable_code, reason = "a variant may have an empty type in the plane")]
        impl<$param: $bound> $crate::lanes::Lanewise for $bundle {
            type Single = $single;
            fn in_all(single: &Self::Single) -> Self {
                match single {
                    $($name::$variant $({ $($field),* })? $(($inner))? => $name::$variant
                        $({ $($field: $crate::lanes::Lanewise::in_all($field)),* })?
                        $(($crate::lanes::Lanewise::in_all($inner)))?,)*
                }
            }
            #[allow(irrefutable_let_patterns, reason = "an enum may have only one variant")]
            fn put(&mut self, lane: usize, single: &Self::Single) {
                match self {
                    $($name::$variant $({ $($field),* })? $(($inner))? => {
                        $($(
                            let bundle = $field;
                            let $name::$variant { $field, .. } = single else {
                                unreachable!("{}", $crate::lanes::ALIKE)
                            };
                            $crate::lanes::Lanewise::put(bundle, lane, $field);
                        )*)?
                        $(
                            let bundle = $inner;
                            let $name::$variant($inner) = single else {
                                unreachable!("{}", $crate::lanes::ALIKE)
                            };
                            $crate::lanes::Lanewise::put(bundle, lane, $inner);
                        )?
                    })*
                }
            }
            fn of_lane(&self, lane: usize) -> Self::Single {
                match self {
                    $($name::$variant $({ $($field),* })? $(($inner))? => $name::$variant
                        $({ $($field: $crate::lanes::Lanewise::of_lane($field, lane)),* })?
                        $(($crate::lanes::Lanewise::of_lane($inner, lane)))?,)*
                }
            }
        }
    };
}

/// Sets one lane of a mask.
pub fn put_truth<M: Mask>(mask: &mut M, lane: usize, single: bool) {
    let others = *mask;
    *mask = M::from_lanes(|l| if l == lane { single } else { others.lane(l) });
}

lanewise!(same(), bool, usize, String, Motion, Basis, Exponent, HalfPlane, NoWhole);

lanewise!(struct Vec2<R> { x, z });
lanewise!(struct Rotation2<R> { cos, sin });
lanewise!(struct Vec3<R> { x, y, z });
lanewise!(struct Rotation3<R> { rows });
lanewise!(struct Quaternion<R> { w, v });
lanewise!(struct Pose<S> { position, orientation });
lanewise!(struct Twist<S> { linear, angular });
lanewise!(struct Wrench<S> { force, moment });
lanewise!(struct Losses<S> { damped, friction });
lanewise!(struct Node<S> { position, tributary_length, outward });
lanewise!(struct Face<S> { point, outward, widest });
lanewise!(struct Placed<S> { surface, offset, rotation });
lanewise!(struct Round<S> {
    center, radius, limits, arc_limits, sides, takes_limit, greatest_depth, tributary_length
});
lanewise!(struct Circle<R> { radius });
lanewise!(struct Cradle<R> { radius, sin, cos });
lanewise!(struct BarrelProfile<R> {
    half_length, head_radius, bilge_radius, stave_radius, rounding, corner_height
});
lanewise!(
    enum Shape<R> {
        Circle(circle),
        HalfPlane(plane),
        Polygon(polygon),
        Cradle(cradle),
        BarrelProfile(profile),
    }
);
lanewise!(struct Ball<R> { radius });
lanewise!(struct Dish<R> { radius });
lanewise!(struct Capsule<R> { half_length, radius });
lanewise!(struct Barrel<R> { half_length, head_radius, stave_radius, stave_offset, rounding });
lanewise!(struct Block<R> { half, rounding });
lanewise!(
    enum Solid<R> {
        HalfSpace,
        Ball(ball),
        Capsule(capsule),
        Barrel(barrel),
        Block(block),
        Dish(dish),
    }
);
lanewise!(
    enum Hull<R> {
        Capsule(capsule),
        Barrel(barrel),
        Block(block),
    }
);
lanewise!(struct Rounded<R> { hull, center, rotation, tributary_length });
lanewise!(enum Nodes<S> {
    Fixed(nodes), Rounds(rounds), Rolling { center, radius, tributary_length }, Whole(none)
});
lanewise!(enum FrictionLaw<R> {
    Frictionless,
    Coulomb { static_coefficient, kinetic_coefficient, tangential_stiffness, tangential_damping },
    Regularized { coefficient, velocity }
});
lanewise!(enum NormalLaw<R> {
    SpeedGap { stiffness, damping },
    KelvinVoigt { stiffness, damping },
    HuntCrossley { stiffness, dissipation, exponent },
    Hertz { stiffness },
    Rebound { stiffness, restitution, speed }
});
lanewise!(struct Stick<S> { displacement, tangent_plane } masks { slipping });
lanewise!(struct Stop<R> { depth, law });
lanewise!(struct Rolling<R> { lever, spin });
lanewise!(struct Interface<S> { name, normal, stop, rolling, friction, basis });
lanewise!(struct Body<S> {
    name, motion, mass, inertia, damping, pose, twist, surfaces, nodes, faces
});

lanewise!(struct Inert<S> { motion, damped, mass, inertia });
lanewise!(struct Substepping<R> { substeps, whole_step_depth, resting_allowance, foreseen_gap, fast });
lanewise!(struct Fast<R> { whole_step_way, hard });

impl<S: Space> Model<S> {
    /// Returns a model that equals `single` in every lane.
    pub(crate) fn in_all(single: &Model<S::Single>) -> Self {
        Self {
            bodies: Lanewise::in_all(&single.bodies),
            inert: Lanewise::in_all(&single.inert),
            interfaces: Lanewise::in_all(&single.interfaces),
            pairs: single.pairs.clone(),
            elements: Lanewise::in_all(&single.elements),
            gravity: Lanewise::in_all(&single.gravity),
            reach: single.reach.clone(),
            alike: single.alike.clone(),
            substepping: Lanewise::in_all(&single.substepping),
        }
    }

    /// Sets the model of one lane.
    pub(crate) fn put(&mut self, lane: usize, single: &Model<S::Single>) {
        self.bodies.put(lane, &single.bodies);
        self.inert.put(lane, &single.inert);
        self.interfaces.put(lane, &single.interfaces);
        self.elements.put(lane, &single.elements);
        self.gravity.put(lane, &single.gravity);
        self.substepping.put(lane, &single.substepping);
        for (reach, single) in self.reach.iter_mut().zip(&single.reach) {
            // The bounding ball must enclose the body of every lane.
            *reach = reach.max(*single);
        }
        for (body, (alike, single)) in self.alike.iter_mut().zip(&single.alike).enumerate() {
            // Bodies with equal boundaries in one case may differ in another case.
            if alike != single {
                *alike = body;
            }
        }
    }
}
