//! A half-plane: everything below the line `z = 0`, such as the floor.

use super::Gap;
use crate::real::Real;
use crate::space::{Planar, Vec2};

/// A half-plane that is solid everywhere below `z = 0` in the frame of the shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HalfPlane;

impl HalfPlane {
    #[inline(always)]
    #[expect(clippy::unused_self, reason = "every shape has this method")]
    pub(super) fn gap<R: Real>(self, point: Vec2<R>) -> Gap<Planar<R>> {
        Gap { distance: point.z, normal: Vec2::new(R::zero(), R::splat(1.0)) }
    }
}
