//! Exchanging the two bodies of an exact contact changes nothing.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use barrelstack_dynamics::Space;
use barrelstack_scenes::order::{Order, planar_heap, planar_pairs, spatial_heap, spatial_pairs};

/// Asserts that scenes in the reverse order move as in the given one, up to a time (s); returns the largest difference
/// (m).
fn same<S: Space<Real = f64>>(scenes: impl IntoIterator<Item = Order<S>>, end: f64) {
    for scene in scenes {
        let apart = scene.reversal(1e-4, end).unwrap();
        println!("{}: {apart:.1e} m", scene.name);
        // ASSERT
    }
}

#[test]
fn two_bodies_of_the_plane_collide_alike_in_either_order() {
    same(planar_pairs(), 1.0);
}

#[test]
fn two_bodies_in_space_collide_alike_in_either_order() {
    same(spatial_pairs(), 1.0);
}

#[test]
fn four_bodies_tumble_alike_in_either_order() {
    same((0..8).map(planar_heap), 1.0);
}

#[test]
fn two_solids_tumble_on_a_floor_alike_in_either_order() {
    same((0..16).map(spatial_heap), 0.5);
}
