//! Intensity measures in customary units, and tables of intensity measures.

use barrelstack_motion::{
    Channel, IntensityMeasure, MotionError, PulseFit, Quantity, Record, RotatedPeak,
    STANDARD_GRAVITY, Sampled, dominant_pulse, rotated_peak, rotated_spectrum,
};

use super::table::{Table, number};

/// A measure, with the name under which it is printed.
pub(super) type Shown = (&'static str, IntensityMeasure);

/// Measures that are always printed.
pub(super) const USUAL: &[Shown] = &[
    ("PGA", IntensityMeasure::Pga),
    ("PGV", IntensityMeasure::Pgv),
    ("PGD", IntensityMeasure::Pgd),
    ("PGV/PGA", IntensityMeasure::PgvOverPga),
    ("Arias intensity", IntensityMeasure::Arias),
    ("CAV", IntensityMeasure::Cav),
    ("duration D5-75", IntensityMeasure::D5_75),
    ("duration D5-95", IntensityMeasure::D5_95),
    ("bracketed at 0.05 g", IntensityMeasure::BRACKETED),
    ("mean period Tm", IntensityMeasure::MeanPeriod),
];

/// Further measures, printed on request.
pub(super) const FURTHER: &[Shown] = &[
    ("CAV, standardized", IntensityMeasure::CavStandardized),
    ("RMS acceleration", IntensityMeasure::Rms),
    ("Housner, 5 %", IntensityMeasure::Housner { damping: 0.05 }),
    ("ASI, 5 %", IntensityMeasure::Asi),
    ("VSI, 5 %", IntensityMeasure::Vsi),
    ("Fajfar index", IntensityMeasure::Fajfar),
    ("FIV3(1.0 s)", IntensityMeasure::Fiv3 { period: 1.0 }),
    ("Sa(0.2 s), 5 %", IntensityMeasure::Sa { period: 0.2, damping: 0.05 }),
    ("Sa(0.5 s), 5 %", IntensityMeasure::Sa { period: 0.5, damping: 0.05 }),
    ("Sa(1.0 s), 5 %", IntensityMeasure::Sa { period: 1.0, damping: 0.05 }),
];

/// Returns the customary unit of a measure, and the number of these units in one SI unit.
pub(super) fn reading(measure: &IntensityMeasure) -> (&'static str, f64) {
    match measure {
        IntensityMeasure::Pga | IntensityMeasure::Rms | IntensityMeasure::Sa { .. } => {
            ("g", 1.0 / STANDARD_GRAVITY)
        }
        IntensityMeasure::Pgv | IntensityMeasure::Fiv3 { .. } => ("cm/s", 100.0),
        IntensityMeasure::Pgd | IntensityMeasure::Housner { .. } | IntensityMeasure::Vsi => {
            ("cm", 100.0)
        }
        IntensityMeasure::PgvOverPga
        | IntensityMeasure::Arias
        | IntensityMeasure::Cav
        | IntensityMeasure::CavStandardized
        | IntensityMeasure::SignificantDuration { .. }
        | IntensityMeasure::BracketedDuration { .. }
        | IntensityMeasure::Asi
        | IntensityMeasure::MeanPeriod
        | IntensityMeasure::Fajfar => (measure.unit(), 1.0),
    }
}

/// Returns the customary unit of a quantity, the number of these units in one SI unit, and the name
/// of the peak of the quantity, such as "PGA".
pub(super) fn peak_reading(quantity: Quantity) -> (&'static str, f64, &'static str) {
    match quantity {
        Quantity::Acceleration => ("g", 1.0 / STANDARD_GRAVITY, "PGA"),
        Quantity::Velocity => ("cm/s", 100.0, "PGV"),
        Quantity::Displacement => ("cm", 100.0, "PGD"),
    }
}

/// Tabulates measures, one per row, with one column per channel.
pub(super) fn table(
    columns: &[(String, &Channel)],
    measures: &[Shown],
) -> Result<Table, MotionError> {
    let names = columns.iter().map(|(name, _)| name.clone());
    let head = ["measure".to_owned(), "unit".to_owned()];
    let mut table = Table::new(2, head.into_iter().chain(names));
    let motions: Vec<Sampled> =
        columns.iter().map(|(_, channel)| channel.sampled()).collect::<Result<_, _>>()?;
    let lengths = motions.iter().map(|motion| number(motion.duration()));
    table.row(["length".to_owned(), "s".to_owned()].into_iter().chain(lengths));
    for (name, measure) in measures {
        let (unit, factor) = reading(measure);
        let values = motions
            .iter()
            .map(|motion| measure.of(motion).map(|value| number(factor * value)))
            .collect::<Result<Vec<_>, _>>()?;
        table.row([(*name).to_owned(), unit.to_owned()].into_iter().chain(values));
    }
    Ok(table)
}

/// Tabulates the usual measures of every channel of a record.
pub(super) fn usual(record: &Record) -> Result<Table, MotionError> {
    table(&columns(record), USUAL)
}

/// Returns the channels of a record with their names.
pub(super) fn columns(record: &Record) -> Vec<(String, &Channel)> {
    record.channels.iter().map(|channel| (channel.name.clone(), channel)).collect()
}

/// Tabulates measures before and after processing, side by side for every channel of both records.
pub(super) fn before_after(before: &Record, after: &Record) -> Result<Table, MotionError> {
    let mut columns = Vec::new();
    for (k, new) in after.channels.iter().enumerate() {
        if let Some(old) = before.channels.get(k) {
            columns.push((format!("{} before", old.name), old));
        }
        columns.push(("after".to_owned(), new));
    }
    table(&columns, USUAL)
}

/// Returns the dominant velocity pulse among periods from 0.3 to 12 s, or in the part of this range
/// that the record allows.
pub(super) fn pulse(motion: &Sampled) -> Result<PulseFit, MotionError> {
    let shortest = (8.0 * motion.time_step()).max(0.3);
    dominant_pulse(motion, shortest, (0.5 * motion.duration()).min(12.0))
}

/// Describes the dominant velocity pulse of every channel, in one sentence per channel.
pub(super) fn pulses(record: &Record) -> Vec<String> {
    let sentence = |channel: &Channel| match channel.sampled().and_then(|motion| pulse(&motion)) {
        Ok(fit) => format!(
            "{}: a velocity pulse of {} s and {} cm/s, starting at {} s, contains {:.0} % of the squared \
             velocity{}",
            channel.name,
            number(fit.period),
            number(100.0 * fit.peak_velocity),
            number(fit.start),
            100.0 * fit.energy_share,
            if fit.energy_share > 0.5 { ": pulse-like" } else { "" }
        ),
        Err(error) => format!("{}: no velocity pulse: {error}", channel.name),
    };
    record.channels.iter().map(sentence).collect()
}

/// A measure over all horizontal directions.
pub(super) struct Rotated {
    /// The measure.
    pub(super) measure: IntensityMeasure,
    /// Name under which the measure is printed.
    pub(super) name: String,
    /// Median and largest value over all directions (SI units).
    pub(super) peak: RotatedPeak,
}

/// Computes `RotD50` and `RotD100` of the two horizontals.
pub(super) fn rotated(record: &Record) -> Result<Vec<Rotated>, MotionError> {
    let (one, two) = record.horizontal_pair()?;
    let (first, second) = (one.sampled()?, two.sampled()?);
    let (a, b) = (first.acceleration(), second.acceleration());
    let row = |measure, name, peak| Rotated { measure, name, peak };
    let mut rows = vec![
        row(IntensityMeasure::Pga, "PGA".to_owned(), rotated_peak(a, b)),
        row(
            IntensityMeasure::Pgv,
            "PGV".to_owned(),
            rotated_peak(first.velocity(), second.velocity()),
        ),
    ];
    let (periods, damping) = ([0.2, 0.5, 1.0], 0.05);
    let spectrum = rotated_spectrum(one.time_step, a, b, &periods, damping)?;
    for (period, peak) in periods.into_iter().zip(spectrum) {
        let measure = IntensityMeasure::Sa { period, damping };
        rows.push(row(measure, format!("Sa({period:.1} s), 5 %"), peak));
    }
    Ok(rows)
}
