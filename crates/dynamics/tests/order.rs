//! Exchanging the two bodies of an exact contact changes nothing.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use barrelstack_dynamics::Space;
use barrelstack_scenes::order::{Order, planar_heap, planar_pairs, spatial_heap, spatial_pairs};

/// Asserts that bodies move in the reverse order as in the given one, over the first second.
fn same<S: Space<Real = f64>>(scenes: impl IntoIterator<Item = Order<S>>) {
    for scene in scenes {
        let apart = scene.reversal(1e-4, 1.0).unwrap();
        println!("{}: {apart:.1e} m", scene.name);
        assert!(apart <= 1e-9, "{}: {apart:.1e} m", scene.name);
    }
}

#[test]
fn two_bodies_of_the_plane_collide_alike_in_either_order() {
    same(planar_pairs()); // measured 2e-18 m
}

#[test]
fn two_bodies_in_space_collide_alike_in_either_order() {
    same(spatial_pairs()); // measured 8e-12 m
}

#[test]
fn four_bodies_tumble_alike_in_either_order() {
    same((0..8).map(planar_heap)); // measured 2e-15 m
}

#[test]
fn two_solids_tumble_on_a_floor_alike_in_either_order() {
    same((0..16).map(spatial_heap));
}
