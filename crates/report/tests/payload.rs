//! The data of a page reproduce the scene, decoded here as by the scripts of the page.

use crate::common::{document, payload, player, scene, unpack};
use barrelstack_report::{POSE_QUANTUM, TIME_QUANTUM, html};

#[test]
fn frames_read_back_within_half_a_quantum() {
    let scene = scene(6, 600);
    let data = payload(&html(&document(vec![player(scene.clone())])));
    let data = &data["players"][0]["panes"][0];
    let times = &unpack(&data["times"])[0];
    let poses = unpack(&data["poses"]);
    assert_eq!((times.len(), poses.len()), (600, 3 * 7));
    let mut worst = 0.0_f64;
    for frame in 0..600 {
        assert!((times[frame] - scene.frames.times[frame]).abs() <= 0.5 * TIME_QUANTUM);
        for body in 0..7 {
            for c in 0..3 {
                let wanted = scene.frames.poses[frame][body][c];
                worst = worst.max((poses[3 * body + c][frame] - wanted).abs());
            }
        }
    }
    assert!(worst <= 0.5 * POSE_QUANTUM, "{worst}"); // half a quantum is 3.05e-5
}

#[test]
fn forces_read_back_at_their_place_in_the_list() {
    let scene = scene(2, 60);
    let data = payload(&html(&document(vec![player(scene.clone())])));
    let forces = &data["players"][0]["panes"][0]["forces"];
    let (x, fz) = (unpack(&forces["x"]), unpack(&forces["fz"]));
    for frame in 0..60 {
        for (slot, force) in scene.frames.forces[frame].iter().enumerate() {
            assert!((x[slot][frame] - force.x).abs() <= 0.5 / 1024.0);
            assert!((fz[slot][frame] - force.fz).abs() <= 0.5); // measured below 0.25 N
        }
    }
}

#[test]
fn a_body_without_a_finite_pose_is_missing_in_that_frame_only() {
    let mut scene = scene(2, 60);
    scene.frames.poses[20][1] = [f64::NAN, 0.0, 0.0];
    scene.frames.poses[21].truncate(1);
    let data = payload(&html(&document(vec![player(scene)])));
    let poses = unpack(&data["players"][0]["panes"][0]["poses"]);
    for channel in &poses[3..6] {
        assert!(channel[20].is_nan() && channel[21].is_nan());
        assert!(channel[19].is_finite() && channel[22].is_finite());
    }
    assert!(poses[6][20].is_finite() && poses[6][21].is_nan());
}

#[test]
fn a_body_that_rolls_away_does_not_widen_the_view() {
    let still = scene(4, 60);
    let mut rolling = still.clone();
    for frame in 30..60 {
        rolling.frames.poses[frame][4][0] += 2.0 * (frame - 29) as f64;
    }
    let width = |scene| {
        let data = payload(&html(&document(vec![player(scene)])));
        let view: Vec<f64> = data["players"][0]["panes"][0]["view"]
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v.as_f64().unwrap())
            .collect();
        view[2] - view[0]
    };
    let (before, after) = (width(still), width(rolling));
    // It may be visible up to the reach of the window, but no farther: it goes 60 m.
    assert!(after - before < 2.5, "{before} {after}"); // measured 2.02
}

#[test]
fn a_minute_of_twenty_bodies_stays_below_three_megabytes() {
    let page = html(&document(vec![player(scene(20, 3601))]));
    let megabytes = page.len() as f64 / 1e6;
    let mut bare = scene(20, 3601);
    bare.frames.forces.clear();
    let without = html(&document(vec![player(bare)])).len() as f64 / 1e6;
    // measured 1.59 with two forces for every body, 0.54 without
    assert!(megabytes < 3.0 && without < 1.0, "{megabytes} {without}");
}
