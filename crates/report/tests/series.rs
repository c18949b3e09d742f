//! Series of files: ParaView files and numbered pictures reproduce the scene.

use crate::common;
use std::sync::Arc;

use crate::common::{Vtk, scene};
use barrelstack_report::{Attachment, Film, POSE_QUANTUM, Role, Scene, paraview};

/// Largest difference (m) between a length and the length that is written: half a quantum and the
/// rounding to single precision.
const NEAR: f64 = 0.51 * POSE_QUANTUM;

fn vtk(files: &[Attachment], name: &str) -> Vtk {
    let file = files.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("no {name}"));
    Vtk::of(&file.bytes)
}

fn text<'a>(files: &'a [Attachment], name: &str) -> &'a str {
    let file = files.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("no {name}"));
    std::str::from_utf8(&file.bytes).expect("UTF-8")
}

/// Computes the points of the bodies independently from the poses.
fn expected(scene: &Scene, frame: usize, body: usize) -> Vec<[f64; 2]> {
    let [x, z, angle] = scene.frames.poses[frame][body];
    let lines = scene.bodies[body].outlines.iter().chain(&scene.bodies[body].marks);
    lines
        .flat_map(|line| &line.points)
        .map(|p| {
            [
                x + angle.cos() * p[0] - angle.sin() * p[1],
                z + angle.sin() * p[0] + angle.cos() * p[1],
            ]
        })
        .collect()
}

#[test]
fn paraview_points_stand_where_the_poses_put_them() {
    let mut scene = scene(3, 61);
    // The ground's line is drawn in; the comparison is for the bodies on it.
    scene.bodies[0].outlines.clear();
    let files = paraview(&scene, 60.0);
    for frame in [0, 1, 37, 60] {
        let file = vtk(&files, &format!("bodies-{frame:04}.vtp"));
        let points = file.vectors("Points", "points");
        let shifts = file.vectors("CellData", "displacement");
        for (cell, body) in file.whole("CellData", "body").into_iter().enumerate() {
            let [now, start] = [frame, 0].map(|frame| scene.frames.poses[frame][body]);
            let [x, y, z] = shifts[cell].map(f64::from);
            assert!((x - (now[0] - start[0])).abs() < NEAR && y == 0.0);
            assert!((z - (now[1] - start[1])).abs() < NEAR);
        }
        let wanted: Vec<[f64; 2]> = (0..4).flat_map(|b| expected(&scene, frame, b)).collect();
        assert_eq!(points.len(), wanted.len());
        assert_eq!(file.count("NumberOfPoints"), wanted.len());
        for (at, [x, z]) in wanted.iter().enumerate() {
            let [px, py, pz] = points[at].map(f64::from);
            assert!((px - x).abs() < NEAR && (pz - z).abs() < NEAR);
            assert_eq!(py, 0.0);
        }
    }
}

#[test]
fn paraview_cells_use_every_point_once_and_name_their_body() {
    let scene = scene(3, 5);
    let files = paraview(&scene, 60.0);
    let file = vtk(&files, "bodies-0002.vtp");
    let mut used = file.whole("Lines", "connectivity");
    used.extend(file.whole("Polys", "connectivity"));
    used.sort_unstable();
    assert_eq!(used, (0..file.count("NumberOfPoints")).collect::<Vec<_>>());
    for (group, what) in [("Lines", "NumberOfLines"), ("Polys", "NumberOfPolys")] {
        let ends = file.whole(group, "offsets");
        assert_eq!(ends.len(), file.count(what));
        assert_eq!(ends.last().copied(), Some(file.whole(group, "connectivity").len()));
    }
    let cells = file.count("NumberOfLines") + file.count("NumberOfPolys");
    assert_eq!(file.whole("CellData", "body").len(), cells);
    // Lines come first: the ground and twelve marks of each barrel, then the three barrels.
    let mut bodies = vec![0];
    bodies.extend((1..=3).flat_map(|b| vec![b; 12]));
    bodies.extend([1, 2, 3]);
    assert_eq!(file.whole("CellData", "body"), bodies);
    assert_eq!(text(&files, "bodies.csv").lines().nth(1), Some("0,ground,ground"));
}

#[test]
fn paraview_forces_are_those_of_the_frame() {
    let mut scene = scene(2, 4);
    scene.frames.forces[3].clear();
    let files = paraview(&scene, 60.0);
    let file = vtk(&files, "forces-0001.vtp");
    let force = file.vectors("PointData", "force");
    let points = file.vectors("Points", "points");
    assert_eq!(force.len(), scene.frames.forces[1].len());
    for (at, wanted) in scene.frames.forces[1].iter().enumerate() {
        // Rounded to single precision.
        for (found, wanted) in force[at].iter().zip([wanted.fx, 0.0, wanted.fz]) {
            assert!((f64::from(*found) - wanted).abs() <= 1e-7 * wanted.abs());
        }
        let [x, y, z] = points[at].map(f64::from);
        assert!((x - wanted.x).abs() < NEAR && y == 0.0 && (z - wanted.z).abs() < NEAR);
    }
    let none = vtk(&files, "forces-0003.vtp");
    assert_eq!(none.count("NumberOfPoints"), 0);
    assert!(none.vectors("Points", "points").is_empty());
}

#[test]
fn the_ground_is_drawn_around_the_bodies_and_not_for_hundreds_of_meters() {
    let scene = scene(4, 5);
    let files = paraview(&scene, 60.0);
    let points = vtk(&files, "bodies-0000.vtp").vectors("Points", "points");
    let widest = points.as_flattened().iter().fold(0.0_f32, |most, v| most.max(v.abs()));
    assert!(widest > 1.5 && widest < 8.0, "{widest}"); // measured 2.7
    let ends: Vec<f32> = points.iter().take(2).map(|p| p[0]).collect();
    assert!(ends[0] < -1.0 && ends[1] > 1.5, "{ends:?}");
}

#[test]
fn the_index_names_every_file_at_its_time() {
    let scene = scene(2, 61);
    let files = paraview(&scene, 10.0);
    let tree = roxmltree::Document::parse(text(&files, "stack.pvd")).expect("well-formed XML");
    let sets: Vec<_> = tree.descendants().filter(|n| n.has_tag_name("DataSet")).collect();
    assert_eq!(sets.len(), 2 * 11);
    for (at, set) in sets.iter().enumerate() {
        let time: f64 = set.attribute("timestep").and_then(|t| t.parse().ok()).expect("a time");
        assert!((time - 0.1 * (at / 2) as f64).abs() < 1e-9);
        vtk(&files, set.attribute("file").expect("a name"));
    }
    assert_eq!(files.len(), 22 + 2);
}

#[test]
fn a_film_takes_the_frames_nearest_to_its_times() {
    let times = |rate: f64, frames: usize| -> Vec<f64> {
        let film = Film::of_run(Arc::new(scene(2, frames)), rate);
        (0..film.len()).filter_map(|at| film.time(at)).collect()
    };
    let close = |a: &[f64], b: &[f64]| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
    };
    assert!(close(&times(20.0, 13), &[0.0, 0.05, 0.1, 0.15, 0.2]));
    // 25 pictures a second of 60 frames a second: the nearest frame, never one twice.
    let uneven = times(25.0, 13);
    assert!(
        uneven.iter().enumerate().all(|(k, t)| (t - 0.04 * k as f64).abs() <= 0.5 / 60.0 + 1e-9)
    );
    assert_eq!(times(1000.0, 13).len(), 13);
    assert_eq!(times(0.0, 13).len(), 13);
    assert_eq!(times(f64::NAN, 13).len(), 13);
    assert_eq!(times(20.0, 1).len(), 1);
    assert!(times(20.0, 0).is_empty());
}

#[test]
fn pictures_of_a_film_have_one_size_and_are_well_formed() {
    let mut moving = scene(3, 60);
    moving.bodies[2].name = common::HOSTILE.into();
    moving.bodies[2].role = Role::Block;
    let film = Film::of_run(Arc::new(moving), 10.0);
    let mut sizes = Vec::new();
    for at in 0..film.len() {
        let svg = film.svg(at).expect("a picture");
        let tree = roxmltree::Document::parse(&svg).expect("well-formed XML");
        let root = tree.root_element();
        sizes.push((
            root.attribute("width").map(str::to_owned),
            root.attribute("height").map(str::to_owned),
        ));
        let uses = tree.descendants().filter(|n| n.has_tag_name("use")).count();
        assert_eq!(uses, 4);
    }
    sizes.dedup();
    assert_eq!(sizes.len(), 1);
    assert_eq!(film.svg(film.len()), None);
}

#[test]
fn scenes_with_nothing_give_an_index_and_no_more() {
    let files = paraview(&Scene::default(), 20.0);
    let names: Vec<&str> = files.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names, ["bodies.csv", "stack.pvd"]);
}
