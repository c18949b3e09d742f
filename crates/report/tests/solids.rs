//! The series of bodies in space for ParaView, read by a parser of its own.

use std::io::Read as _;

use barrelstack_report::{Role, SolidBody, SolidTie, Solids, paraview_of_solids};
use base64::Engine as _;

/// A tetrahedron of a level.
fn tetrahedron(name: &str, level: u32) -> SolidBody {
    SolidBody {
        name: name.into(),
        role: Role::Barrel,
        level,
        points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
    }
}

/// Returns the bytes of an array: one block, whose sizes are in its header.
fn bytes(tree: &roxmltree::Document<'_>, name: &str, kind: &str) -> Vec<u8> {
    let mut nodes = tree.descendants().filter(|node| node.attribute("Name") == Some(name));
    // The cells of triangles come after those of lines.
    let node = nodes.next_back().unwrap();
    assert_eq!(node.attribute("type"), Some(kind), "{name}");
    assert_eq!(node.attribute("format"), Some("binary"));
    // Sixteen bytes take 24 letters.
    let (header, data) = node.text().unwrap().trim().split_at(24);
    let decode = |text: &str| base64::prelude::BASE64_STANDARD.decode(text).unwrap();
    let header: Vec<usize> = decode(header)
        .chunks(4)
        .map(|word| u32::from_le_bytes(word.try_into().unwrap()) as usize)
        .collect();
    let packed = decode(data);
    let mut unpacked = Vec::new();
    flate2::read::ZlibDecoder::new(packed.as_slice()).read_to_end(&mut unpacked).unwrap();
    assert_eq!(header, [1, unpacked.len(), 0, packed.len()]);
    unpacked
}

fn vectors(tree: &roxmltree::Document<'_>, name: &str) -> Vec<[f32; 3]> {
    let numbers: Vec<f32> = bytes(tree, name, "Float32")
        .chunks(4)
        .map(|word| f32::from_le_bytes(word.try_into().unwrap()))
        .collect();
    numbers.chunks(3).map(|vector| vector.try_into().unwrap()).collect()
}

fn whole(tree: &roxmltree::Document<'_>, name: &str) -> Vec<i32> {
    bytes(tree, name, "Int32")
        .chunks(4)
        .map(|word| i32::from_le_bytes(word.try_into().unwrap()))
        .collect()
}

#[test]
fn paraview_sees_bodies_in_space_where_they_are_and_as_they_move() {
    let rest = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let quarter = 0.5_f64.sqrt();
    // A quarter turn about z, and moved.
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
        files.push((file.name, String::from_utf8(file.bytes).unwrap()));
        Ok(())
    })
    .unwrap();
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    // The second frame is not due.
    assert_eq!(names, ["bodies-0000.vtp", "bodies-0001.vtp", "bodies.csv", "stack.pvd"]);
    assert_eq!(
        files[2].1,
        "body,name,role,level\n0,\"one, \"\"quoted\"\"\",barrel,1\n1,two,barrel,2\n"
    );
    let index = roxmltree::Document::parse(&files[3].1).unwrap();
    let sets = index.descendants().filter(|node| node.has_tag_name("DataSet"));
    let listed: Vec<_> =
        sets.map(|set| (set.attribute("timestep"), set.attribute("file"))).collect();
    let entry = |time, file| (Some(time), Some(file));
    assert_eq!(listed, [entry("0", "bodies-0000.vtp"), entry("1", "bodies-0001.vtp")]);

    let first = roxmltree::Document::parse(&files[0].1).unwrap();
    assert_eq!(vectors(&first, "points").len(), 8);
    assert_eq!(whole(&first, "body"), [0, 0, 0, 0, 1, 1, 1, 1]);
    assert_eq!(whole(&first, "level"), [1, 1, 1, 1, 2, 2, 2, 2]);
    assert_eq!(whole(&first, "connectivity")[12..15], [4, 6, 5]);
    assert_eq!(whole(&first, "offsets"), [3, 6, 9, 12, 15, 18, 21, 24]);

    // A lost body is left out entirely.
    let last = roxmltree::Document::parse(&files[1].1).unwrap();
    assert_eq!(whole(&last, "body"), [0; 4]);
    let near = |found: &[f32; 3], exact: [f32; 3]| {
        found.iter().zip(exact).all(|(found, exact)| (found - exact).abs() < 1e-6)
    };
    // The corner on x goes to y.
    assert!(near(&vectors(&last, "points")[1], [2.0, 4.0, 4.0]));
    assert!(near(&vectors(&last, "displacement")[1], [1.0, 4.0, 4.0]));
    // Its center moves along x, and it rotates about it.
    assert!(near(&vectors(&last, "velocity")[1], [-1.0, 0.0, 0.0]));
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
        files.push(String::from_utf8(file.bytes).unwrap());
        Ok(())
    })
    .unwrap();
    assert!(files[2].ends_with("2,two-one left,device,0\n"), "{}", files[2]);
    let tree = roxmltree::Document::parse(&files[0]).unwrap();
    // The line comes before the triangles, and its points before theirs.
    assert_eq!(whole(&tree, "body"), [2, 0, 0, 0, 0, 1, 1, 1, 1]);
    assert_eq!(whole(&tree, "role")[0], Role::Device as i32);
    assert_eq!(vectors(&tree, "points")[..2], [[1.0, 0.0, 3.0], [1.0, 0.0, 0.5]]);
    assert_eq!(whole(&tree, "connectivity")[..3], [2, 4, 3]);
    let torn = roxmltree::Document::parse(&files[1]).unwrap();
    assert_eq!(whole(&torn, "body"), [0, 0, 0, 0, 1, 1, 1, 1]);
}
