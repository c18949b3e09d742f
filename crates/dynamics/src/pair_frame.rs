//! Relative pose of two bodies in the frame of a surface, and a filter that selects their contacts by their position
//! relative to a face.

use crate::model::{ContactPair, Counts, Model};
use crate::real::{Mask, Real};
use crate::space::{Linear, Pose, Space};

/// Relative pose of two bodies in the frame of the target's surface.
///
/// The contacts of a pair are computed in this frame, and only their sum is rotated to the inertial frame.
#[derive(Clone, Debug)]
pub(crate) struct PairFrame<S: Space> {
    /// Rotation from the surface's frame to the inertial frame.
    pub(crate) rotation: S::Rotation,
    /// Rotation from the contactor's body frame to the surface's frame.
    pub(crate) relative: S::Rotation,
    /// Center of mass of the contactor (m) in the surface's frame.
    pub(crate) contactor: S::Vector,
    /// Center of mass of the target (m) in the surface's frame.
    pub(crate) target: S::Vector,
    /// Rotation from the surface's frame to the target's body frame.
    placed: S::Rotation,
}

/// Filter that selects the contacts of a pair by their position relative to a face, as [`Counts`] requires.
#[derive(Clone, Copy)]
pub(crate) struct AtFace<S: Space> {
    /// Lanes in which the center of mass of the body without this face lies in front of the face.
    before: <S::Real as Real>::Mask,
    /// Unit normal of the face, in the frame of the target's surface. Like a contact normal, it points out of the
    /// target: it is the outward normal of a face of the target, or the inward normal of a face of the contactor.
    out: S::Vector,
    /// Copy of [`Face::widest`](crate::body::Face::widest).
    widest: S::Real,
    of_nodes: bool,
}

impl<S: Space> AtFace<S> {
    /// Returns `true` if no contact can count.
    #[inline(always)]
    pub(crate) fn never(&self) -> bool {
        let all = S::Real::splat(-1.0);
        if self.of_nodes { !self.before.any() } else { (self.before & self.widest.lt(all)).all() }
    }

    /// Returns `true` if every contact counts.
    #[inline(always)]
    pub(crate) fn always(&self) -> bool {
        let all = S::Real::splat(-1.0);
        if self.of_nodes { (self.before & self.widest.lt(all)).all() } else { !self.before.any() }
    }

    /// Returns the lanes in which a contact with this normal counts.
    #[inline(always)]
    pub(crate) fn counts(&self, normal: S::Vector) -> <S::Real as Real>::Mask {
        let of_face = self.before & self.widest.le(normal.dot(self.out));
        if self.of_nodes { of_face } else { !of_face }
    }
}

impl<S: Space> PairFrame<S> {
    #[inline(always)]
    pub(crate) fn new(
        model: &Model<S>,
        pair: &ContactPair,
        poses: &[Pose<S>],
        rotations: &[S::Rotation],
    ) -> Self {
        let placed = &model.bounded(pair.target).surfaces[pair.surface];
        let target_rotation = rotations[pair.target];
        let rotation = S::compose(target_rotation, placed.rotation);
        let origin = poses[pair.target].position + S::rotate(target_rotation, placed.offset);
        let apart = poses[pair.contactor].position - origin;
        Self {
            rotation,
            relative: S::relative(rotation, rotations[pair.contactor]),
            contactor: S::unrotate(rotation, apart),
            target: -S::unrotate(placed.rotation, placed.offset),
            placed: placed.rotation,
        }
    }

    /// Returns the distance (m) by which the other body's center of mass lies in front of the face that filters the
    /// contacts of a pair; negative behind the face. The other body is the one without this face. Returns `None` for
    /// [`Counts::Everywhere`].
    #[inline(always)]
    pub(crate) fn before(&self, model: &Model<S>, pair: &ContactPair) -> Option<S::Real> {
        let apart = self.target - self.contactor;
        let (face, other) = match pair.counts {
            Counts::Everywhere => return None,
            Counts::BeforeFace(face) | Counts::BehindFace(face) => {
                (&model.bounded(pair.contactor).faces[face], S::unrotate(self.relative, apart))
            }
            Counts::BehindFaceOfTarget(face) => {
                (&model.bounded(pair.target).faces[face], S::rotate(self.placed, -apart))
            }
        };
        Some((other - face.point).dot(face.outward))
    }

    /// Returns the contact filter of a pair; `None` for [`Counts::Everywhere`].
    #[inline(always)]
    pub(crate) fn at_face(&self, model: &Model<S>, pair: &ContactPair) -> Option<AtFace<S>> {
        let before = S::Real::zero().lt(self.before(model, pair)?);
        let (face, out, of_nodes) = match pair.counts {
            Counts::Everywhere => return None,
            Counts::BeforeFace(face) | Counts::BehindFace(face) => {
                let face = &model.bounded(pair.contactor).faces[face];
                // The outward normal of the contactor points into the target.
                let out = -S::rotate(self.relative, face.outward);
                (face, out, matches!(pair.counts, Counts::BeforeFace(_)))
            }
            Counts::BehindFaceOfTarget(face) => {
                let face = &model.bounded(pair.target).faces[face];
                (face, S::unrotate(self.placed, face.outward), false)
            }
        };
        Some(AtFace { before, out, widest: face.widest, of_nodes })
    }

    /// Transforms a direction from the surface's frame to the contactor's body frame.
    #[inline(always)]
    pub(crate) fn to_contactor(&self, direction: S::Vector) -> S::Vector {
        S::unrotate(self.relative, direction)
    }

    /// Transforms a direction from the contactor's body frame to the surface's frame.
    #[inline(always)]
    pub(crate) fn direction_to_surface(&self, direction: S::Vector) -> S::Vector {
        S::rotate(self.relative, direction)
    }

    /// Transforms a point from the contactor's body frame to the surface's frame.
    #[inline(always)]
    pub(crate) fn to_surface(&self, position: S::Vector) -> S::Vector {
        self.contactor + S::rotate(self.relative, position)
    }
}
