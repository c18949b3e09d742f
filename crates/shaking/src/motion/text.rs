//! Reading and writing of the table `[motion]`.

use barrelstack_input::reader::Reader;
use barrelstack_input::tree::Table;
use barrelstack_input::writer::Writer;
use barrelstack_input::{Dimension, InputError};
use barrelstack_motion::{IntensityMeasure, MotionError};

use super::fields::{LONGEST, MOTION, PULSE, SCALE, SHOCK, SINE, SOURCES};
use super::{
    Amplitude, MeasuredOn, MotionSource, MotionSpec, Pulse, PulseKind, RecordMotion, RecordSource,
    Scale, Sine, Vertical,
};

/// Returns the specification of ground at rest.
pub fn rest() -> MotionSpec {
    MotionSpec { source: MotionSource::None, scale: Scale::Factor(1.0), similitude: 1.0 }
}

/// Reads the ground motion of a single stack or scene, which is one shock.
///
/// # Errors
/// If a field is invalid, or if the motion is a sequence. The error names the first such field, with its place in the
/// file.
pub fn read(reader: Reader<'_>) -> Result<MotionSpec, InputError> {
    if reader.has("sequence") {
        let message = "only a cellar can run a sequence of shocks: set `kind = \"cellar\"`, and state [room] and one \
                       [[block]] that consists of this stack; or state one shock in [motion]";
        return Err(reader.inconsistent("sequence", message.to_owned()));
    }
    reader.skip("sequence");
    read_shock(reader)
}

/// Reads the description of one shock: a table `[motion]` without `sequence`, or one element of `sequence`.
///
/// # Errors
/// If a field is invalid. The error names the first such field, with its place in the file.
pub fn read_shock(reader: Reader<'_>) -> Result<MotionSpec, InputError> {
    let record = reader.file("record")?.map(RecordSource::File);
    let bundled = reader.optional_catalog_name("bundled")?.map(RecordSource::Bundled);
    let details = read_record_details(&reader)?;
    let sine = reader.optional_section("sine")?.map(read_sine).transpose()?;
    let pulse = reader.optional_section("pulse")?.map(read_pulse).transpose()?;
    let none = reader.optional_flag("none")?;
    if none == Some(false) {
        let message = format!("`{}` must be true or left out", reader.path_of("none"));
        return Err(reader.inconsistent("none", message));
    }
    let source = if let Some(source) = record.or(bundled) {
        MotionSource::Record(RecordMotion { source, ..details })
    } else if let Some(sine) = sine {
        MotionSource::Sine(sine)
    } else if let Some(pulse) = pulse {
        MotionSource::Pulse(pulse)
    } else if none.is_some() {
        MotionSource::None
    } else {
        return Err(reader.one_of(SOURCES));
    };
    let scale = match reader.optional_section("scale")? {
        Some(scale) => read_scale(scale)?,
        None => Scale::Factor(1.0),
    };
    let both = matches!(scale, Scale::Measure { of, .. } if of != MeasuredOn::Component);
    if both && !matches!(source, MotionSource::Record(_)) {
        let message = format!(
            "`{}` can refer to both horizontal components only for a recorded motion; leave the field `of` out",
            reader.path_of("scale")
        );
        return Err(reader.inconsistent("scale", message));
    }
    let similitude = reader.number("similitude")?;
    reader.finish();
    Ok(MotionSpec { source, scale, similitude })
}

/// Reads all fields of a record except its source, which the caller sets.
fn read_record_details(reader: &Reader<'_>) -> Result<RecordMotion, InputError> {
    let component = reader.optional_text("component")?;
    let vertical_component = reader.optional_text("vertical")?.map(Vertical::Component);
    let vertical_file = reader.file("vertical_record")?.map(Vertical::File);
    Ok(RecordMotion {
        source: RecordSource::Bundled(String::new()),
        component,
        vertical: vertical_component.or(vertical_file).unwrap_or(Vertical::None),
        time_step: reader.optional_quantity("time_step")?,
        unit: reader.optional_quantity("unit")?,
        sensitivity: reader.optional_number("sensitivity")?,
        processing: reader.choice("processing")?,
        obtain: reader.optional_text("obtain")?,
    })
}

fn read_scale(reader: Reader<'_>) -> Result<Scale, InputError> {
    let factor = reader.optional_number("factor")?;
    if factor == Some(0.0) {
        let message = format!(
            "`{}` must not be 0; for a ground at rest write `none = true` in [motion]",
            reader.path_of("factor")
        );
        return Err(reader.inconsistent("factor", message));
    }
    let pga = reader.optional_quantity("pga")?;
    let pgv = reader.optional_quantity("pgv")?;
    let measured = read_measured(&reader)?;
    let scale = factor
        .map(Scale::Factor)
        .or(pga.map(Scale::Pga))
        .or(pgv.map(Scale::Pgv))
        .or(measured)
        .ok_or_else(|| reader.one_of(&["factor", "pga", "pgv", "measure"]))?;
    reader.finish();
    Ok(scale)
}

/// Reads the fields `measure`, `value` and `of`; `None` if `measure` and `value` are missing.
fn read_measured(reader: &Reader<'_>) -> Result<Option<Scale>, InputError> {
    let value = reader.optional_quantity_with_dimension("value")?;
    let of = reader.choice("of")?;
    let Some(text) = reader.optional_text("measure")? else {
        if value.is_some() {
            return Err(reader.missing("measure"));
        }
        return Ok(None);
    };
    let measure: IntensityMeasure = text
        .parse()
        .map_err(|error: MotionError| reader.inconsistent("measure", error.to_string()))?;
    let Some(dimension) = dimension_of(measure) else {
        let message = format!(
            "`{}`: a motion cannot be scaled to {measure}; choose a measure that increases with the amplitude \
             of the motion and has a unit of acceleration, velocity or length",
            reader.path_of("measure")
        );
        return Err(reader.inconsistent("measure", message));
    };
    let quantity = value.ok_or_else(|| reader.missing("value"))?;
    if quantity.dimension != dimension {
        let message = format!(
            "`{}` of {measure} must be a quantity such as \"{}\"",
            reader.path_of("value"),
            dimension.example()
        );
        return Err(reader.inconsistent("value", message));
    }
    Ok(Some(Scale::Measure { measure, value: quantity.value, of }))
}

/// Returns the dimension of a measure; `None` if a scenario cannot scale the motion to this measure.
fn dimension_of(measure: IntensityMeasure) -> Option<Dimension> {
    match measure.unit() {
        "m/s2" => Some(Dimension::ACCELERATION),
        "m/s" => Some(Dimension::VELOCITY),
        "m" => Some(Dimension::LENGTH),
        _ => None,
    }
}

fn read_amplitude(reader: &Reader<'_>) -> Result<Amplitude, InputError> {
    let quantity = reader
        .optional_quantity_with_dimension("amplitude")?
        .ok_or_else(|| reader.missing("amplitude"))?;
    Ok(if quantity.dimension == Dimension::LENGTH {
        Amplitude::Displacement(quantity.value)
    } else if quantity.dimension == Dimension::VELOCITY {
        Amplitude::Velocity(quantity.value)
    } else {
        Amplitude::Acceleration(quantity.value)
    })
}

fn read_period(reader: &Reader<'_>) -> Result<f64, InputError> {
    let period = reader.optional_quantity("period")?;
    let frequency = reader.optional_quantity("frequency")?;
    period
        .or(frequency.map(|frequency| 1.0 / frequency))
        .ok_or_else(|| reader.one_of(&["period", "frequency"]))
}

fn read_sine(reader: Reader<'_>) -> Result<Sine, InputError> {
    let period = read_period(&reader)?;
    let cycles = reader.optional_number("cycles")?;
    let duration = reader.optional_quantity("duration")?;
    let cycles = cycles
        .or(duration.map(|duration| duration / period))
        .ok_or_else(|| reader.one_of(&["cycles", "duration"]))?;
    if cycles * period > LONGEST {
        let message =
            format!("{cycles} cycles of {period} s last longer than {LONGEST} s; use fewer cycles");
        return Err(reader.inconsistent("cycles", message));
    }
    let ramp_cycles = reader.number("ramp_cycles")?;
    if 2.0 * ramp_cycles > cycles {
        let message = format!(
            "`{}` is {ramp_cycles}, but the ramps at both ends of the motion must fit into its {cycles} cycles; state \
             at most {}",
            reader.path_of("ramp_cycles"),
            0.5 * cycles
        );
        return Err(reader.inconsistent("ramp_cycles", message));
    }
    let sine = Sine {
        amplitude: read_amplitude(&reader)?,
        period,
        cycles,
        ramp_cycles,
        direction: reader.choice("direction")?,
    };
    reader.finish();
    Ok(sine)
}

fn read_pulse(reader: Reader<'_>) -> Result<Pulse, InputError> {
    let mut kind = reader.choice("kind")?;
    if let PulseKind::Gabor { gamma, phase } | PulseKind::MavroeidisPapageorgiou { gamma, phase } =
        &mut kind
    {
        (*gamma, *phase) = (reader.number("gamma")?, reader.quantity("phase")?);
    } else if let PulseKind::CycloidC { cycles } = &mut kind {
        *cycles = reader.integer("cycles")?;
    }
    let pulse = Pulse {
        kind,
        amplitude: read_amplitude(&reader)?,
        period: read_period(&reader)?,
        start: reader.quantity("start")?,
        direction: reader.choice("direction")?,
    };
    reader.finish();
    Ok(pulse)
}

/// Writes the ground motion.
pub fn write(motion: &MotionSpec) -> Table {
    let mut writer = Writer::new(&MOTION);
    writer.omit(&["sequence"]);
    write_shock(writer, motion)
}

/// Writes a sequence of shocks.
pub fn write_sequence<'a>(shocks: impl IntoIterator<Item = &'a MotionSpec>) -> Table {
    let mut writer = Writer::new(&MOTION);
    let all = shocks.into_iter().map(|shock| write_shock(Writer::new(&SHOCK), shock)).collect();
    writer.tables("sequence", all);
    SHOCK.fields.iter().for_each(|field| writer.omit(&[field.name]));
    writer.finish()
}

fn write_shock(mut writer: Writer, motion: &MotionSpec) -> Table {
    match &motion.source {
        MotionSource::None => writer.flag("none", true),
        MotionSource::Record(record) => write_record(&mut writer, record),
        MotionSource::Sine(sine) => writer.table("sine", write_sine(sine)),
        MotionSource::Pulse(pulse) => writer.table("pulse", write_pulse(pulse)),
    }
    if matches!(motion.source, MotionSource::None) {
        writer.omit(&["scale"]);
    } else {
        writer.table("scale", write_scale(motion.scale));
    }
    writer.number("similitude", motion.similitude);
    writer.omit(SOURCES);
    writer.omit(&[
        "component",
        "vertical",
        "vertical_record",
        "time_step",
        "unit",
        "sensitivity",
        "processing",
        "obtain",
    ]);
    writer.finish()
}

fn write_record(writer: &mut Writer, record: &RecordMotion) {
    match &record.source {
        RecordSource::File(file) => writer.text("record", &file.path),
        RecordSource::Bundled(name) => writer.text("bundled", name),
    }
    writer.optional_text("component", record.component.as_deref());
    match &record.vertical {
        Vertical::None => {}
        Vertical::Component(name) => writer.text("vertical", name),
        Vertical::File(file) => writer.text("vertical_record", &file.path),
    }
    writer.optional_quantity("time_step", record.time_step);
    writer.optional_quantity("unit", record.unit);
    if let Some(sensitivity) = record.sensitivity {
        writer.number("sensitivity", sensitivity);
    }
    writer.choice("processing", record.processing);
    writer.optional_text("obtain", record.obtain.as_deref());
}

fn write_scale(scale: Scale) -> Table {
    let mut writer = Writer::new(&SCALE);
    match scale {
        Scale::Factor(factor) => writer.number("factor", factor),
        Scale::Pga(pga) => writer.quantity("pga", pga),
        Scale::Pgv(pgv) => writer.quantity("pgv", pgv),
        Scale::Measure { measure, value, of } => {
            writer.text("measure", &measure.to_string());
            if let Some(dimension) = dimension_of(measure) {
                writer.quantity_in("value", value, dimension);
            }
            writer.choice("of", of);
        }
    }
    writer.omit(&["factor", "pga", "pgv", "measure", "value", "of"]);
    writer.finish()
}

fn write_amplitude(writer: &mut Writer, amplitude: Amplitude) {
    let (value, dimension) = match amplitude {
        Amplitude::Displacement(value) => (value, Dimension::LENGTH),
        Amplitude::Velocity(value) => (value, Dimension::VELOCITY),
        Amplitude::Acceleration(value) => (value, Dimension::ACCELERATION),
    };
    writer.quantity_in("amplitude", value, dimension);
}

fn write_sine(sine: &Sine) -> Table {
    let mut writer = Writer::new(&SINE);
    write_amplitude(&mut writer, sine.amplitude);
    writer.quantity("period", sine.period);
    writer.number("cycles", sine.cycles);
    writer.number("ramp_cycles", sine.ramp_cycles);
    writer.choice("direction", sine.direction);
    writer.omit(&["frequency", "duration"]);
    writer.finish()
}

fn write_pulse(pulse: &Pulse) -> Table {
    let mut writer = Writer::variant(&PULSE, pulse.kind);
    if let PulseKind::Gabor { gamma, phase } | PulseKind::MavroeidisPapageorgiou { gamma, phase } =
        pulse.kind
    {
        writer.number("gamma", gamma);
        writer.quantity("phase", phase);
    } else if let PulseKind::CycloidC { cycles } = pulse.kind {
        writer.integer("cycles", cycles);
    }
    write_amplitude(&mut writer, pulse.amplitude);
    writer.quantity("period", pulse.period);
    writer.quantity("start", pulse.start);
    writer.choice("direction", pulse.direction);
    writer.omit(&["frequency"]);
    writer.finish()
}
