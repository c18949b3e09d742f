//! Paths of the barrels in variants (trails), encoded so that engines can exchange them for a report.

use std::collections::BTreeMap;

use barrelstack::ensemble::Trail;

/// Paths of barrels, by the index of the plane and the number of the variant.
pub(crate) type Trails = BTreeMap<(u32, u32), Trail>;

/// Encodes the paths of barrels in little-endian form: numbers and lengths in four bytes each, positions in
/// single precision.
pub(crate) fn written<'a>(trails: impl IntoIterator<Item = ((u32, u32), &'a Trail)>) -> Vec<u8> {
    let mut out = Vec::new();
    let number = |number: usize, out: &mut Vec<u8>| {
        // The conversion is exact, because no stack has that many bodies.
        out.extend(u32::try_from(number).unwrap_or(u32::MAX).to_le_bytes());
    };
    for ((plane, variant), trail) in trails {
        out.extend([plane, variant].iter().flat_map(|number| number.to_le_bytes()));
        for bodies in [&trail.top, &trail.barrels] {
            number(bodies.len(), &mut out);
            for body in bodies {
                number(*body, &mut out);
            }
        }
        for path in &trail.paths {
            number(path.len(), &mut out);
            out.extend(path.iter().flatten().flat_map(|place| place.to_le_bytes()));
        }
        out.extend(trail.last.iter().flatten().flat_map(|place| place.to_le_bytes()));
    }
    out
}

/// Decodes the paths of barrels; `None` if the bytes end too early.
pub(crate) fn read(mut bytes: &[u8]) -> Option<Trails> {
    let mut all = Trails::new();
    while !bytes.is_empty() {
        let key = (whole(&mut bytes)?, whole(&mut bytes)?);
        let mut bodies = || {
            let count = whole(&mut bytes)?;
            (0..count).map(|_| usize::try_from(whole(&mut bytes)?).ok()).collect::<Option<Vec<_>>>()
        };
        let (top, barrels) = (bodies()?, bodies()?);
        let mut paths = Vec::new();
        for _ in &top {
            let count = whole(&mut bytes)?;
            let path = (0..count).map(|_| Some([place(&mut bytes)?, place(&mut bytes)?]));
            paths.push(path.collect::<Option<Vec<_>>>()?);
        }
        let mut last = Vec::new();
        for _ in &barrels {
            last.push([place(&mut bytes)?, place(&mut bytes)?, place(&mut bytes)?]);
        }
        all.insert(key, Trail { top, paths, barrels, last });
    }
    Some(all)
}

fn four(bytes: &mut &[u8]) -> Option<[u8; 4]> {
    let (four, rest) = bytes.split_first_chunk::<4>()?;
    *bytes = rest;
    Some(*four)
}

fn whole(bytes: &mut &[u8]) -> Option<u32> {
    four(bytes).map(u32::from_le_bytes)
}

fn place(bytes: &mut &[u8]) -> Option<f32> {
    four(bytes).map(f32::from_le_bytes)
}

#[cfg(test)]
mod tests {
    use super::{Trail, Trails, read, written};

    #[test]
    fn trails_come_back_and_no_end_of_them_is_taken_for_whole() {
        let trail = |seed: f32| Trail {
            top: vec![7, 9],
            paths: vec![vec![[seed, 0.1]; 3], vec![[f32::MIN_POSITIVE, -seed]]],
            barrels: vec![3, 7, 9],
            last: vec![[seed, f32::NAN.min(1.0), 1e-30]; 3],
        };
        let all: Trails =
            [((0, 0), trail(1.0)), ((1, 0), trail(0.3)), ((0, 5), Trail::default())].into();
        let bytes = written(all.iter().map(|(key, trail)| (*key, trail)));
        assert_eq!(read(&bytes).unwrap(), all);
        let ends: Vec<usize> =
            (0..bytes.len()).filter(|end| read(&bytes[..*end]).is_some()).collect();
        // A prefix is valid after zero, one and two trails.
        assert_eq!(ends.len(), 3);
    }
}
