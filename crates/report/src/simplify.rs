//! Simplification of polylines by omitting points that make no visible difference.

/// Simplifies the polyline `run`: the result deviates from `run` by at most about `tolerance` (px).
///
/// The polyline is first thinned. If x never decreases, the first, lowest, highest and last point of every half pixel
/// along x remain, which looks the same; otherwise, points closer than `tolerance` to the previous remaining point are
/// removed. The Ramer–Douglas–Peucker algorithm then removes points on nearly straight stretches.
pub(crate) fn simplify(run: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    if run.len() < 3 {
        return run.to_vec();
    }
    let advancing = run.windows(2).all(|pair| pair[1][0] >= pair[0][0]);
    let thinned = if advancing { by_column(run, 0.5) } else { by_distance(run, tolerance) };
    douglas_peucker(&thinned, tolerance)
}

fn by_column(run: &[[f64; 2]], width: f64) -> Vec<[f64; 2]> {
    let column = |p: &[f64; 2]| (p[0] / width).floor();
    let mut out = Vec::new();
    for group in run.chunk_by(|a, b| column(a) == column(b)) {
        let extreme = |sign: f64| {
            (0..group.len())
                .max_by(|&a, &b| (sign * group[a][1]).total_cmp(&(sign * group[b][1])))
                .unwrap_or(0)
        };
        let mut keep = [0, extreme(1.0), extreme(-1.0), group.len() - 1];
        keep.sort_unstable();
        out.extend(keep.chunk_by(|a, b| a == b).map(|same| group[same[0]]));
    }
    out
}

fn by_distance(run: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let mut out = vec![run[0]];
    let mut last = run[0];
    for point in &run[1..run.len() - 1] {
        if (point[0] - last[0]).hypot(point[1] - last[1]) >= tolerance {
            out.push(*point);
            last = *point;
        }
    }
    out.push(run[run.len() - 1]);
    out
}

fn douglas_peucker(run: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let mut keep = vec![false; run.len()];
    keep[0] = true;
    keep[run.len() - 1] = true;
    let mut open = vec![(0, run.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (run[from], run[to]);
        let mut worst = (tolerance, None);
        for (at, point) in run.iter().enumerate().take(to).skip(from + 1) {
            let distance = from_segment(*point, a, b);
            if distance > worst.0 {
                worst = (distance, Some(at));
            }
        }
        if let Some(at) = worst.1 {
            keep[at] = true;
            open.push((from, at));
            open.push((at, to));
        }
    }
    run.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

fn from_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx * dx + dy * dy;
    let along = if length > 0.0 {
        (((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (p[0] - a[0] - along * dx).hypot(p[1] - a[1] - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_one_sample_wide_survives() {
        let mut run: Vec<[f64; 2]> = (0..10_000).map(|k| [f64::from(k) * 0.06, 50.0]).collect();
        run[5003][1] = 3.0;
        let kept = simplify(&run, 0.1);
        assert!(kept.contains(&run[5003]));
        assert!(kept.len() < 10);
    }

    #[test]
    fn a_closed_loop_keeps_its_shape() {
        let run: Vec<[f64; 2]> = (0..=3600)
            .map(|k| (f64::from(k) / 3600.0 * std::f64::consts::TAU).sin_cos())
            .map(|(s, c)| [100.0 * c, 100.0 * s])
            .collect();
        let kept = simplify(&run, 0.1);
        assert!(kept.len() > 20 && kept.len() < 400); // measured below 150
        assert!(kept.iter().all(|p| (p[0].hypot(p[1]) - 100.0).abs() < 1e-9));
    }
}
