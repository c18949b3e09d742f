//! Force histories.

/// Returns the sum of two force histories. Each history is zero outside its samples, and linear between them.
pub(crate) fn summed(one: &[(f64, [f64; 3])], other: &[(f64, [f64; 3])]) -> Vec<(f64, [f64; 3])> {
    if one.is_empty() || other.is_empty() {
        return if one.is_empty() { other.to_vec() } else { one.to_vec() };
    }
    let at = |all: &[(f64, [f64; 3])], time: f64| -> [f64; 3] {
        let next = all.partition_point(|(at, _)| *at < time);
        match (next.checked_sub(1).map(|before| all[before]), all.get(next)) {
            (_, Some((at, force))) if *at == time => *force,
            (Some((from, old)), Some((to, new))) => {
                let share = (time - from) / (to - from);
                std::array::from_fn(|axis| old[axis] + share * (new[axis] - old[axis]))
            }
            (_, _) => [0.0; 3],
        }
    };
    let mut times: Vec<f64> = one.iter().chain(other).map(|(time, _)| *time).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let sum = |time: f64| {
        let (a, b) = (at(one, time), at(other, time));
        (time, std::array::from_fn(|axis| a[axis] + b[axis]))
    };
    times.into_iter().map(sum).collect()
}
