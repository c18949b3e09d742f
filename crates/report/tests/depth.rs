//! Scenes in three dimensions: what the page gets of them.

use crate::common::{document, payload, player, scene, unpack};
use serde_json::json;

use barrelstack_report::{
    Depth, DepthBody, DepthPoses, DepthTie, Moment, POSE_QUANTUM, Pose3, Role, Scene, Volume, html,
};

fn barrel(name: &str) -> DepthBody {
    let profile = vec![[-0.475, 0.29], [0.0, 0.345], [0.475, 0.29]];
    let volume = Volume::Turned { at: [0.0; 3], axis: [0.0, 1.0, 0.0], profile };
    DepthBody {
        name: name.into(),
        role: Role::Barrel,
        volumes: vec![volume],
        rows: vec![[0.0; 3], [0.0, 1.0, 0.0]],
    }
}

/// Returns a pose that rotates about the vertical by more than half a turn. The scalar part of its quaternion is never
/// negative, so the sign of the quaternion jumps at half a turn.
fn turning(frame: usize) -> Pose3 {
    let half = 0.05 * frame as f64;
    let sign = if half.cos() < 0.0 { -1.0 } else { 1.0 };
    [0.5, -0.25, 1.0, sign * half.cos(), 0.0, 0.0, sign * half.sin()]
}

fn deep(poses: DepthPoses, frames: usize) -> Scene {
    let mut flat = scene(2, frames);
    let ground = DepthBody { volumes: Vec::new(), role: Role::Ground, ..barrel("ground") };
    flat.depth = Some(Depth {
        bodies: vec![ground, barrel("B1"), barrel("B2")],
        poses,
        ties: vec![DepthTie { bodies: [1, 2], points: [[0.0; 3]; 2], torn_at: None }],
        events: flat.events.clone(),
        moment: Some(Moment { time: f64::NAN, body: 1, text: "never".into(), falls: true }),
        paths: vec![2, 3],
        forces: Vec::new(),
        panes: Vec::new(),
    });
    flat
}

#[test]
fn equal_solids_are_written_once_and_a_moment_without_a_time_is_left_out() {
    let page = html(&document(vec![player(deep(DepthPoses::Across, 20))]));
    let depth = &payload(&page)["players"][0]["panes"][0]["depth"];
    assert_eq!(
        depth["shapes"].as_array().unwrap().len(),
        2,
        "that of the ground, and one for both barrels"
    );
    assert_eq!(depth["bodies"][1]["shape"], depth["bodies"][2]["shape"]);
    assert_eq!(depth["plane"], "across");
    // A path belongs to the trace with the same index, so the path of a missing body stays in the list.
    assert_eq!(depth["paths"], json!([2, 3]));
    assert!(depth["poses"].is_null() && depth["moment"].is_null());
    assert_eq!(depth["events"][0]["text"], "B1 falls");
}

#[test]
fn quaternions_keep_their_turn_and_their_sign_does_not_jump() {
    let count = 100;
    let frames = (0..count).map(|frame| vec![turning(frame); 3]).collect();
    let page = html(&document(vec![player(deep(DepthPoses::Free(frames), count))]));
    let channels = unpack(&payload(&page)["players"][0]["panes"][0]["depth"]["poses"]);
    assert_eq!(channels.len(), 21);
    for frame in 0..count {
        let pose: Vec<f64> = (7..14).map(|channel| channels[channel][frame]).collect();
        // A quaternion and its negative describe the same rotation.
        let same: f64 = pose[3..].iter().zip(&turning(frame)[3..]).map(|(a, b)| a * b).sum();
        assert!((same.abs() - 1.0).abs() < 2.0 * POSE_QUANTUM, "frame {frame}: {same}");
        assert_eq!(pose[..3], [0.5, -0.25, 1.0]);
        if frame > 0 {
            let step: f64 = (10..14)
                .map(|c| (channels[c][frame] - channels[c][frame - 1]).abs())
                .fold(0.0, f64::max);
            assert!(step < 0.06, "frame {frame}: a jump of {step}");
        }
    }
}

#[test]
fn forces_in_space_read_back_at_their_place_and_a_place_without_force_is_a_gap() {
    let count = 30;
    let push = |frame: usize, slot: usize| -> [[f64; 3]; 2] {
        let at = frame as f64;
        let force =
            if slot == 1 && frame < 10 { [0.0; 3] } else { [-20.0 * at, 30.0, 1000.0 + at] };
        [[0.1 * at, slot as f64, -0.5], force]
    };
    let forces: Vec<Vec<_>> =
        (0..count).map(|frame| (0..2).map(|slot| push(frame, slot)).collect()).collect();
    let mut scene = deep(DepthPoses::Free(vec![vec![turning(0); 3]; count]), count);
    let depth = scene.depth.as_mut().unwrap();
    depth.forces.clone_from(&forces);
    depth.panes = vec![[0, 2], [1, 2]];
    let page = html(&document(vec![player(scene)]));
    let depth = &payload(&page)["players"][0]["panes"][0]["depth"];
    assert_eq!(depth["axes"], json!([[0, 2], [1, 2]]));
    for axis in 0..3 {
        let at = unpack(&depth["forces"]["at"][axis]);
        let force = unpack(&depth["forces"]["force"][axis]);
        for (frame, list) in forces.iter().enumerate() {
            for (slot, [point, components]) in list.iter().enumerate() {
                if *components == [0.0; 3] {
                    assert!(at[slot][frame].is_nan() && force[slot][frame].is_nan());
                } else {
                    assert!((at[slot][frame] - point[axis]).abs() <= 0.5 / 512.0);
                    assert!((force[slot][frame] - components[axis]).abs() <= 0.5);
                }
            }
        }
    }
}

#[test]
fn only_pages_with_depth_hold_three_js_with_its_license() {
    let held = "<script type=\"text/plain\" id=\"three\">";
    let with = html(&document(vec![player(deep(DepthPoses::Along, 20))]));
    let without = html(&document(vec![player(scene(2, 20))]));
    assert!(with.contains(held) && !without.contains(held));
    // 150 kB compressed with gzip; base 85 adds a quarter.
    assert!(with.len() - without.len() < 190_000, "{} bytes", with.len() - without.len());
}
