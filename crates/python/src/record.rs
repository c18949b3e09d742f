//! Records: read from files or made from arrays, processed, scaled, matched and measured.

use std::sync::Arc;

use barrelstack::scenario::{Dimension, Quantity};
use barrelstack_motion::{
    AccelerationUnit, Channel, Component, FORMATS, GroundMotion, Horizontals, IntensityMeasure,
    MatchMethod, Matching, MeanRemoval, MotionError, Pads, Processing, ReadOptions,
    ResponseSpectrum, Stage, TargetSpectrum, Utc, bundled, missed_in_words, read, rotated_spectrum,
    write,
};
use numpy::{IntoPyArray as _, PyReadonlyArray1};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors;
use crate::scenario::bytes;
use crate::view::{Numbers, view};

/// Python handle of a `barrelstack_motion::Record`.
#[pyclass(frozen, module = "barrelstack._native")]
pub(crate) struct Record {
    pub(crate) inner: Arc<barrelstack_motion::Record>,
}

impl From<barrelstack_motion::Record> for Record {
    fn from(inner: barrelstack_motion::Record) -> Self {
        Self { inner: Arc::new(inner) }
    }
}

/// A channel: its name, azimuth (degrees), `true` if it is vertical, time step (s) and start time.
type ChannelFacts = (String, Option<f64>, bool, f64, Option<String>);

#[pymethods]
impl Record {
    #[staticmethod]
    fn read(
        py: Python<'_>,
        data: &[u8],
        name: &str,
        unit: Option<&str>,
        time_step: Option<f64>,
        sensitivity: Option<f64>,
    ) -> PyResult<Self> {
        let unit = unit.map(str::parse::<AccelerationUnit>).transpose().map_err(errors::motion)?;
        let options = ReadOptions { unit, time_step, sensitivity, ..ReadOptions::default() };
        let record = py.detach(|| read(data, name, &options));
        record.map(Self::from).map_err(|error| errors::read(&error))
    }

    #[staticmethod]
    fn bundled(name: &str) -> Option<Self> {
        bundled(name).map(Self::from)
    }

    #[staticmethod]
    fn of_samples(
        name: &str,
        channels: Vec<(String, PyReadonlyArray1<'_, f64>)>,
        time_step: f64,
        unit: &str,
        raw: bool,
        start: Option<&str>,
        station: &str,
    ) -> PyResult<Self> {
        let unit: AccelerationUnit = unit.parse().map_err(errors::motion)?;
        let start: Option<Utc> = start.map(str::parse).transpose().map_err(errors::motion)?;
        let samples: Vec<(&str, Vec<f64>)> = channels
            .iter()
            .map(|(name, values)| (name.as_str(), values.as_array().to_vec()))
            .collect();
        let channels: Vec<(&str, &[f64])> =
            samples.iter().map(|(name, values)| (*name, values.as_slice())).collect();
        let record = barrelstack_motion::Record::of_samples(name, &channels, time_step, unit);
        let mut record = record.map_err(errors::motion)?;
        if raw {
            record.stage = Stage::Raw;
        }
        station.clone_into(&mut record.station);
        for channel in &mut record.channels {
            channel.start = start;
            station.clone_into(&mut channel.site.station);
        }
        Ok(record.into())
    }

    #[staticmethod]
    fn gather(records: Vec<PyRef<'_, Self>>) -> PyResult<Self> {
        let records: Vec<_> = records.iter().map(|record| (*record.inner).clone()).collect();
        barrelstack_motion::Record::gather(&records).map(Self::from).map_err(errors::motion)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.inner.file
    }

    #[getter]
    fn format(&self) -> &str {
        self.inner.format
    }

    #[getter]
    fn event(&self) -> &str {
        &self.inner.event
    }

    #[getter]
    fn station(&self) -> &str {
        &self.inner.station
    }

    #[getter]
    fn stage(&self) -> String {
        self.inner.stage.to_string()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.inner.notes.clone()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.inner.warnings.iter().map(ToString::to_string).collect()
    }

    fn channels(&self) -> Vec<ChannelFacts> {
        let facts = |channel: &Channel| {
            let start = channel.start.map(|start| start.to_string());
            let azimuth = channel.direction.azimuth;
            let (name, step) = (channel.name.clone(), channel.time_step);
            (name, azimuth, channel.is_vertical(), step, start)
        };
        self.inner.channels.iter().map(facts).collect()
    }

    fn acceleration<'py>(slf: &Bound<'py, Self>, channel: usize) -> PyResult<Numbers<'py>> {
        let record = slf.get();
        view(slf.as_any(), &record.channel(channel)?.acceleration)
    }

    /// Returns velocities (m/s) and displacements (m) at the samples.
    fn integrated<'py>(
        &self,
        py: Python<'py>,
        channel: usize,
    ) -> PyResult<(Numbers<'py>, Numbers<'py>)> {
        let motion = self.channel(channel)?.sampled().map_err(errors::motion)?;
        let array = |values: &[f64]| values.to_vec().into_pyarray(py);
        Ok((array(motion.velocity()), array(motion.displacement())))
    }

    /// Returns the index of the channel for the component with the given name.
    fn find(&self, name: &str) -> PyResult<usize> {
        let wanted: Component = name.parse().map_err(errors::motion)?;
        let found = self.inner.component(&wanted).map_err(errors::motion)?;
        let known = self.inner.channels.iter().position(|channel| channel.name == found.name);
        known.ok_or_else(|| {
            PyIndexError::new_err(format!(
                "the record has no channel {name}; rotate the record first"
            ))
        })
    }

    /// Returns a record with only the named component. If the name is an azimuth that no channel has, the component is
    /// computed from two horizontal components.
    fn component(&self, name: &str) -> PyResult<Self> {
        let wanted: Component = name.parse().map_err(errors::motion)?;
        let channel = self.inner.component(&wanted).map_err(errors::motion)?;
        let channels = vec![channel];
        Ok(barrelstack_motion::Record { channels, ..(*self.inner).clone() }.into())
    }

    #[expect(clippy::too_many_arguments, reason = "the keyword arguments of the Python method")]
    fn process(
        &self,
        py: Python<'_>,
        chain: &str,
        mean: Option<&str>,
        detrend: Option<bool>,
        taper: Option<f64>,
        high_pass: Option<f64>,
        low_pass: Option<f64>,
        order: Option<u32>,
        pads: Option<bool>,
        close: Option<bool>,
    ) -> PyResult<Self> {
        let mut steps = match chain {
            "default" => Processing::for_stage(self.inner.stage),
            "raw" => Processing::raw(),
            "compact" => Processing::compact(),
            "none" => Processing::none(),
            other => {
                return Err(PyValueError::new_err(format!(
                    "chain: expected \"default\", \"raw\", \"compact\" or \"none\", found \"{other}\""
                )));
            }
        };
        steps.mean = match mean {
            None => steps.mean,
            Some("keep") => MeanRemoval::Keep,
            Some("pre-event") => MeanRemoval::PreEvent,
            Some("whole") => MeanRemoval::Whole,
            Some(other) => {
                return Err(PyValueError::new_err(format!(
                    "mean: expected \"keep\", \"pre-event\" or \"whole\", found \"{other}\""
                )));
            }
        };
        steps.detrend = detrend.unwrap_or(steps.detrend);
        steps.taper = taper.unwrap_or(steps.taper);
        steps.high_pass = high_pass.or(steps.high_pass);
        steps.low_pass = low_pass.or(steps.low_pass);
        steps.order = order.unwrap_or(steps.order);
        steps.pads = match pads {
            None => steps.pads,
            Some(true) => Pads::Kept,
            Some(false) => Pads::Removed,
        };
        steps.close = close.unwrap_or(steps.close);
        py.detach(|| self.inner.processed(&steps)).map(Self::from).map_err(errors::motion)
    }

    /// Multiplies all components by one factor.
    fn multiplied(&self, factor: f64) -> PyResult<Self> {
        if !(factor.is_finite() && factor != 0.0) {
            return Err(PyValueError::new_err(format!(
                "expected a factor other than 0, found {factor}"
            )));
        }
        let mut record = self.inner.multiplied(factor);
        record.notes.push(format!("scaled by {factor}; one factor for all components"));
        Ok(record.into())
    }

    /// Scales all components by the factor that brings an intensity measure to `value` (SI units). The argument
    /// `of` is a component, or a combination of both horizontals such as `rotd50`.
    fn scaled_to(&self, measure: &str, value: f64, of: &str) -> PyResult<Self> {
        let measure: IntensityMeasure = measure.parse().map_err(errors::motion)?;
        let factor = self.factor(measure, value, of).map_err(errors::motion)?;
        let mut record = self.inner.multiplied(factor);
        record.notes.push(format!(
            "scaled by {factor:.6}, which brings {measure} of {of} to {value} {}; one factor for all components",
            measure.unit()
        ));
        Ok(record.into())
    }

    /// Matches the response spectrum of one component, or of both horizontals over all directions, to
    /// a target. Returns the matched record, its largest misfit, and a description of the periods at
    /// which it misses the target.
    #[expect(clippy::too_many_arguments, reason = "the keyword arguments of the Python method")]
    fn matched(
        &self,
        py: Python<'_>,
        target: &Bound<'_, PyAny>,
        damping: f64,
        of: &str,
        frequency: bool,
        periods: (f64, f64),
        tolerance: f64,
        nearly: bool,
    ) -> PyResult<(Self, f64, String)> {
        let (target, named): (TargetSpectrum, String) = if let Ok(text) = target.extract::<String>()
        {
            (text.parse().map_err(errors::motion)?, text)
        } else {
            let points: Vec<(f64, f64)> = target.extract()?;
            let table = TargetSpectrum::Table { points, damping };
            let named = table.to_string();
            (table, named)
        };
        let method = if frequency { MatchMethod::Frequency } else { MatchMethod::Time };
        let (shortest, longest) = periods;
        let settings = Matching { method, shortest, longest, tolerance, ..Matching::default() };
        let found = if let Ok(measure) = of.parse::<Horizontals>() {
            py.detach(|| self.inner.matched_pair(measure, &target, &named, &settings, nearly))
                .map(|(record, found)| (record, found.misfit, found.missed))
        } else {
            let place = self.find(of)?;
            py.detach(|| self.inner.matched(place, &target, &named, &settings, nearly))
                .map(|(record, found)| (record, found.misfit, found.missed))
        };
        let (record, misfit, missed) = found.map_err(errors::motion)?;
        Ok((record.into(), misfit, missed_in_words(&missed)))
    }

    /// Returns the value (SI units) of a measure for every component, and the unit; the value is
    /// NaN for a component that is too short.
    fn intensity(&self, py: Python<'_>, measure: &str) -> PyResult<(Vec<f64>, &'static str)> {
        let measure: IntensityMeasure = measure.parse().map_err(errors::motion)?;
        let of = |channel: &Channel| measure.of(&channel.sampled()?);
        let values =
            py.detach(|| self.inner.channels.iter().map(of).collect::<Result<Vec<f64>, _>>());
        Ok((values.map_err(errors::motion)?, measure.unit()))
    }

    /// Returns the pseudo-acceleration (m/s²) of a component at given periods (s).
    fn spectrum<'py>(
        &self,
        py: Python<'py>,
        periods: PyReadonlyArray1<'py, f64>,
        damping: f64,
        of: &str,
    ) -> PyResult<Numbers<'py>> {
        let periods = periods.as_array().to_vec();
        let values = py.detach(|| self.pseudo_acceleration(&periods, damping, of));
        Ok(values.map_err(errors::motion)?.into_pyarray(py))
    }

    /// Returns the bytes of a file that contains the record.
    fn written<'py>(&self, py: Python<'py>, form: &str) -> PyResult<Bound<'py, PyBytes>> {
        let text = |text: Result<String, MotionError>| text.map(String::into_bytes);
        let written = match form {
            "npz" => write::npz(&self.inner),
            "txt" => text(write::text(&self.inner)),
            "csv" => text(write::csv(&self.inner)),
            "at2" => text(write::at2(&self.inner)),
            other => {
                return Err(PyValueError::new_err(format!(
                    "a record can be written as .npz, .txt, .csv or .at2, not as .{other}"
                )));
            }
        };
        Ok(bytes(py, &written.map_err(errors::motion)?))
    }
}

impl Record {
    fn channel(&self, at: usize) -> PyResult<&Channel> {
        let missing = || {
            PyIndexError::new_err(format!("the record has {} channels", self.inner.channels.len()))
        };
        self.inner.channels.get(at).ok_or_else(missing)
    }

    fn factor(&self, measure: IntensityMeasure, value: f64, of: &str) -> Result<f64, MotionError> {
        if let Ok(over) = of.parse::<Horizontals>() {
            let (first, second) = self.inner.horizontal_pair()?;
            return over.scale_factor(measure, &first.sampled()?, &second.sampled()?, value);
        }
        let channel = self.inner.component(&of.parse::<Component>()?)?;
        let horizontal = barrelstack_motion::History::Sampled(channel.sampled()?);
        GroundMotion::new(channel.name, horizontal, None).scale_factor(measure, value)
    }

    fn pseudo_acceleration(
        &self,
        periods: &[f64],
        damping: f64,
        of: &str,
    ) -> Result<Vec<f64>, MotionError> {
        if let Ok(over) = of.parse::<Horizontals>() {
            let (one, two) = self.inner.horizontal_pair()?;
            let (a, b) = (one.acceleration.as_slice(), two.acceleration.as_slice());
            if over != Horizontals::GeometricMean {
                let median = over == Horizontals::RotD50;
                let peaks = rotated_spectrum(one.time_step, a, b, periods, damping)?;
                return Ok(peaks
                    .iter()
                    .map(|p| if median { p.median } else { p.largest })
                    .collect());
            }
            let of = |values| {
                Ok(ResponseSpectrum::new(one.time_step, values, periods, damping)?
                    .pseudo_acceleration())
            };
            let (a, b): (Vec<f64>, Vec<f64>) = (of(a)?, of(b)?);
            return Ok(a.iter().zip(&b).map(|(a, b)| (a * b).sqrt()).collect());
        }
        let channel = self.inner.component(&of.parse::<Component>()?)?;
        let spectrum =
            ResponseSpectrum::new(channel.time_step, &channel.acceleration, periods, damping)?;
        Ok(spectrum.pseudo_acceleration())
    }
}

/// Samples a motion as a record. The time step is `History::natural_step` of the horizontal
/// component, or of the vertical component of a purely vertical motion.
pub(crate) fn of_motion(motion: &GroundMotion) -> PyResult<Record> {
    let step = match &motion.vertical {
        // A purely vertical motion has a horizontal component of length zero.
        Some(vertical) if motion.horizontal.duration() == 0.0 => vertical.natural_step(),
        Some(_) | None => motion.horizontal.natural_step(),
    };
    barrelstack_motion::Record::of_motion(motion, step).map(Record::from).map_err(errors::motion)
}

/// Returns periods (s) from 0.01 to 10 s, with the given number of periods per decade.
#[pyfunction]
pub(crate) fn standard_periods(py: Python<'_>, per_decade: usize) -> Numbers<'_> {
    barrelstack_motion::standard_periods(per_decade).into_pyarray(py)
}

/// Parses the value of an intensity measure, such as `50 cm/s`, and converts it to SI units.
#[pyfunction]
pub(crate) fn measured(measure: &str, text: &str) -> PyResult<f64> {
    let of: IntensityMeasure = measure.parse().map_err(errors::motion)?;
    let dimension = match of.unit() {
        "m/s2" => Dimension::ACCELERATION,
        "m/s" => Dimension::VELOCITY,
        "m" => Dimension::LENGTH,
        "s" => Dimension::TIME,
        unit => {
            return Err(PyValueError::new_err(format!(
                "{measure} must be a number in {unit}, found \"{text}\""
            )));
        }
    };
    let quantity = Quantity::parse_as(text, &[dimension]);
    quantity
        .map(|quantity| quantity.value)
        .map_err(|error| PyValueError::new_err(format!("{measure}: {error}")))
}

/// Groups paths, relative to a folder, into records; returns the name and the files of each.
#[pyfunction]
pub(crate) fn group_files(paths: Vec<String>) -> Vec<(String, Vec<String>)> {
    barrelstack_motion::group_files(&paths)
        .into_iter()
        .map(|record| (record.name, record.files))
        .collect()
}

/// Returns names and titles of the supported file formats.
#[pyfunction]
pub(crate) fn formats() -> Vec<(&'static str, &'static str)> {
    FORMATS.iter().map(|format| (format.name, format.title)).collect()
}
