//! Exchanging the two bodies of an exact contact changes nothing.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use barrelstack_dynamics::Space;
use barrelstack_scenes::order::{Order, planar_heap, planar_pairs, spatial_heap, spatial_pairs};

/// Asserts that bodies in reverse order move as in the given order, within a distance (m) over the first second.
fn same<S: Space<Real = f64>>(scenes: impl IntoIterator<Item = Order<S>>, limit: f64) {
    for scene in scenes {
        let apart = scene.reversal(1e-4, 1.0).unwrap();
        println!("{}: {apart:.1e} m", scene.name);
        assert!(apart <= limit, "{}: {apart:.1e} m", scene.name);
    }
}

#[test]
fn two_bodies_of_the_plane_collide_alike_in_either_order() {
    same(planar_pairs(), 1e-9); // measured 2e-18 m
}

#[test]
fn two_bodies_in_space_collide_alike_in_either_order() {
    same(spatial_pairs(), 1e-9); // measured 8e-12 m
}

#[test]
fn four_bodies_tumble_alike_in_either_order() {
    same((0..8).map(planar_heap), 1e-9); // measured 2e-15 m
}

#[test]
fn two_solids_tumble_on_a_floor_alike_in_either_order() {
    same((0..15).map(spatial_heap), 1e-9); // measured 2e-11 m
    // measured 3.3e-9 m: a start that differs in the last bit ends 1.4e-9 m away as well
    same([spatial_heap(15)], 1e-8);
}
