//! Posts of a rack that carry the next rack, and the cups that hold that rack in place.

use barrelstack_dynamics::Shape;
use barrelstack_dynamics::Vec2;
use barrelstack_dynamics::shape::{Polygon, PolygonError};

use super::solid::{Seat, Solid};
use super::transverse::TUBE_CORNER;
use crate::scenario::{Posts, Rack};

/// Play (m) between a post and the cup of the foot that stands on the post: an assumption.
const SPIGOT_PLAY: f64 = 0.005;

/// Half the thickness (m) of the lips of a cup: an assumption.
const LIP_RADIUS: f64 = 0.004;

/// Returns the distance (m) from the middle of a post to the outside of the cup over it.
pub fn cup(rack: &Rack) -> f64 {
    0.5 * rack.rail_width + SPIGOT_PLAY + 2.0 * LIP_RADIUS
}

/// Returns the displacement (m), relative to the rack below, beyond which the foot of a rack is no longer supported.
///
/// `spacing` is the distance (m) of the posts from the middle of the rack below.
pub(super) fn reach(rack: &Rack, spacing: f64) -> f64 {
    // A foot and its post have the same width, so the foot is off the post once it is displaced by that width.
    rack.rail_width.min(spacing)
}

/// Returns the two posts of a rack at `spacing` (m) from its middle, and the cups with which the rack sits on the posts
/// below.
///
/// Cups are lips that hold a rack in place until the rack is lifted off; a rack on the floor has no cups.
pub(super) fn posts_and_cups(
    rack: &Rack,
    posts: &Posts,
    spacing: f64,
    level: u32,
) -> Result<Vec<Solid>, PolygonError> {
    let mut solids = Vec::new();
    let height = posts.height - rack.beam_height;
    let half = 0.5 * rack.rail_width;
    for side in [-1.0, 1.0] {
        let post = side * spacing;
        solids.push(Solid::exact(
            Shape::Polygon(Polygon::rectangle(rack.rail_width, height, TUBE_CORNER.min(half))?),
            Vec2::new(post, rack.beam_height + 0.5 * height),
            Seat::Rack,
        ));
        if level > 1 && posts.spigot > 0.0 {
            for beside in [-1.0, 1.0] {
                let x = post + beside * (half + SPIGOT_PLAY + LIP_RADIUS);
                let hang = (posts.spigot - LIP_RADIUS).max(LIP_RADIUS);
                solids.push(Solid::exact(
                    Shape::Polygon(Polygon::bar(
                        Vec2::new(0.0, 0.5 * hang),
                        Vec2::new(0.0, -0.5 * hang),
                        LIP_RADIUS,
                    )?),
                    Vec2::new(x, -0.5 * hang),
                    Seat::None,
                ));
            }
        }
    }
    Ok(solids)
}
