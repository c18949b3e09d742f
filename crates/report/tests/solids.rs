//! The ParaView series of three-dimensional bodies, read by an independent parser.

use crate::common::Vtk;
use barrelstack_report::{Role, SolidBody, SolidTie, Solids, paraview_of_solids};

/// Returns a tetrahedron on a level.
fn tetrahedron(name: &str, level: u32) -> SolidBody {
    SolidBody {
        name: name.into(),
        role: Role::Barrel,
        level,
        points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
    }
}

#[test]
fn paraview_sees_bodies_in_space_where_they_are_and_as_they_move() {
    let rest = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let quarter = 0.5_f64.sqrt();
    // A quarter turn about z, and a displacement.
    let moved = [2.0, 3.0, 4.0, quarter, 0.0, 0.0, quarter];
    let lost = [f64::NAN; 7];
    let solids = Solids {
        bodies: vec![tetrahedron("one, \"quoted\"", 1), tetrahedron("two", 2)],
        ties: Vec::new(),
        times: vec![0.0, 0.01, 1.0],
        poses: vec![vec![rest, moved], vec![rest, rest], vec![moved, lost]],
        twists: vec![vec![[0.0; 6]; 2], vec![[0.0; 6]; 2], vec![[1.0, 0.0, 0.0, 0.0, 0.0, 2.0]; 2]],
    };
    let mut files = Vec::new();
    paraview_of_solids::<()>(&solids, 1.0, &mut |file| {
        files.push((file.name, file.bytes));
        Ok(())
    })
    .unwrap();
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    // The second frame follows too soon after the first and is left out.
    assert_eq!(names, ["bodies-0000.vtp", "bodies-0001.vtp", "bodies.csv", "stack.pvd"]);
    assert_eq!(
        String::from_utf8_lossy(&files[2].1),
        "body,name,role,level\n0,\"one, \"\"quoted\"\"\",barrel,1\n1,two,barrel,2\n"
    );
    let index = std::str::from_utf8(&files[3].1).unwrap();
    let index = roxmltree::Document::parse(index).unwrap();
    let sets = index.descendants().filter(|node| node.has_tag_name("DataSet"));
    let listed: Vec<_> =
        sets.map(|set| (set.attribute("timestep"), set.attribute("file"))).collect();
    let entry = |time, file| (Some(time), Some(file));
    assert_eq!(listed, [entry("0", "bodies-0000.vtp"), entry("1", "bodies-0001.vtp")]);

    let first = Vtk::of(&files[0].1);
    assert_eq!(first.vectors("Points", "points").len(), 8);
    assert_eq!(first.whole("CellData", "body"), [0, 0, 0, 0, 1, 1, 1, 1]);
    assert_eq!(first.whole("CellData", "level"), [1, 1, 1, 1, 2, 2, 2, 2]);
    assert_eq!(first.whole("Polys", "connectivity")[12..15], [4, 6, 5]);
    assert_eq!(first.whole("Polys", "offsets"), [3, 6, 9, 12, 15, 18, 21, 24]);

    // A body whose pose is not finite is left out entirely.
    let last = Vtk::of(&files[1].1);
    assert_eq!(last.whole("CellData", "body"), [0; 4]);
    let near = |found: &[f32; 3], exact: [f32; 3]| {
        found.iter().zip(exact).all(|(found, exact)| (found - exact).abs() < 1e-6)
    };
    // The quarter turn moves the corner on the x axis to the direction of y.
    assert!(near(&last.vectors("Points", "points")[1], [2.0, 4.0, 4.0]));
    assert!(near(&last.vectors("CellData", "displacement")[1], [2.0, 3.0, 4.0]));
    // The velocity of this corner is that of the origin, along x, plus that of the rotation about the origin.
    assert!(near(&last.vectors("PointData", "velocity")[1], [-1.0, 0.0, 0.0]));
}

#[test]
fn paraview_sees_straps_until_they_tear() {
    let rest = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let above = [0.0, 0.0, 3.0, 1.0, 0.0, 0.0, 0.0];
    let solids = Solids {
        bodies: vec![tetrahedron("one", 1), tetrahedron("two", 2)],
        ties: vec![SolidTie {
            name: "two-one left".into(),
            bodies: [1, 0],
            points: [[1.0, 0.0, 0.0], [1.0, 0.0, 0.5]],
            torn_at: Some(0.5),
        }],
        times: vec![0.0, 1.0],
        poses: vec![vec![rest, above]; 2],
        twists: vec![vec![[0.0; 6]; 2]; 2],
    };
    let mut files = Vec::new();
    paraview_of_solids::<()>(&solids, 1.0, &mut |file| {
        files.push(file.bytes);
        Ok(())
    })
    .unwrap();
    assert!(files[2].ends_with(b"2,two-one left,device,0\n"));
    let tree = Vtk::of(&files[0]);
    // The line precedes the triangles, and the points of the line precede those of the triangles.
    assert_eq!(tree.whole("CellData", "body"), [2, 0, 0, 0, 0, 1, 1, 1, 1]);
    assert_eq!(tree.whole("CellData", "role")[0], Role::Device as usize);
    assert_eq!(tree.vectors("Points", "points")[..2], [[1.0, 0.0, 3.0], [1.0, 0.0, 0.5]]);
    assert_eq!(tree.whole("Polys", "connectivity")[..3], [2, 4, 3]);
    let torn = Vtk::of(&files[1]);
    assert_eq!(torn.whole("CellData", "body"), [0, 0, 0, 0, 1, 1, 1, 1]);
}
