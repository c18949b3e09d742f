//! Header keywords in the languages of the agencies, in lower case and without accents.

/// Keywords for the time between samples.
pub(super) const STEP_KEYS: &[&str] = &[
    "dt",
    "delta t",
    "delta-t",
    "delta_t",
    "deltat",
    "time step",
    "timestep",
    "time-step",
    "time_step",
    "time increment",
    "time interval",
    "time intervals",
    "sampling interval",
    "sample interval",
    "sampling period",
    "sample period",
    "sampling time",
    "sampling step",
    "intervals of",
    "equally spaced at",
    "passo di campionamento",
    "intervallo di campionamento",
    "intervalo de muestreo",
    "ornekleme araligi",
    "pas de temps",
    "pas d'echantillonnage",
    "zeitschritt",
    "abtastintervall",
    "intervalo de amostragem",
    "intervalo de tiempo",
    "paso de tiempo",
    "passo temporale",
    "time between samples",
    "interval of sampling",
    "sampling_interval",
    "sampling_interval_s",
    "sample_interval",
    "time_step_s",
    "dt_s",
    "dt_sec",
    // LabVIEW.
    "delta_x",
    "wf_increment",
    "interval cuplik",
    "interval sampling",
    "krok czasowy",
    "korak uzorkovanja",
    "шаг дискретизации",
    "采样间隔",
    "サンプリング間隔",
];

/// Keywords for the sampling rate.
pub(super) const RATE_KEYS: &[&str] = &[
    "sampling rate",
    "sample rate",
    "sampling_rate",
    "samplerate",
    "sampling frequency",
    "sampling freq",
    "sample frequency",
    "fs",
    "frequenza di campionamento",
    "frecuencia de muestreo",
    "tasa de muestreo",
    "taxa de amostragem",
    "frequencia de amostragem",
    "frequence d'echantillonnage",
    "abtastrate",
    "abtastfrequenz",
    "ornekleme frekansi",
    "ornekleme hizi",
    "samples per second",
    "samples per sec",
    "samples/second",
    "samples/sec",
    "f_s",
    "fs_hz",
    "sample_rate",
    "sample_rate_hz",
    "sampling_rate_hz",
    "sampling_frequency",
    "sampling_frequency_hz",
    "laju cuplik",
    "laju sampling",
    "frekuensi cuplik",
    "frekuensi sampling",
    "rata de esantionare",
    "frecventa de esantionare",
    "czestotliwosc probkowania",
    "vzorkovaci frekvence",
    "frekvencija uzorkovanja",
    "частота дискретизации",
    "采样率",
    "采样频率",
    "サンプリング周波数",
];

/// Keywords for a sampling interval or rate; the unit or the size of the number determines which of the
/// two is meant.
pub(super) const SAMPLING_KEYS: &[&str] = &[
    "sampling",
    "sampled at",
    "resampled to",
    "rate",
    "muestreo",
    "campionamento",
    "amostragem",
    "abtastung",
    "delta",
    "step",
    "interval",
    "intervalo",
    "intervallo",
    "increment",
];

/// Keywords in [`SAMPLING_KEYS`] that may be followed by a number without a unit.
pub(super) const BARE: &[&str] =
    &["sampling", "muestreo", "campionamento", "amostragem", "abtastung", "delta"];

/// Parts of words that identify a time on the same line, such as `5 ms`, as the time step.
pub(super) const BESIDE_STEPS: &[&str] = &["interval", "step", "increment", "spac", "sampl"];

/// Keywords for the number of samples.
pub(super) const COUNT_KEYS: &[&str] = &[
    "npts",
    "ndata",
    "nsamp",
    "nsamples",
    "no. of points",
    "no of points",
    "no. of data",
    "no. of samples",
    "number of points",
    "number of samples",
    "number of data",
    "number of data points",
    "number of values",
    "number of acceleration values",
    "number of acceleration points",
    "num samples",
    "num_samples",
    "samples",
    "points",
    "data points",
    "numero dati",
    "numero di campioni",
    "numero de datos",
    "numero de muestras",
    "numero de amostras",
    "nombre de points",
    "nombre d'echantillons",
    "anzahl der werte",
    "anzahl werte",
    "veri sayisi",
    "muestras",
    "jumlah data",
    "numar de puncte",
    "liczba probek",
    "broj tocaka",
    "数据点数",
    "データ数",
];

/// Keywords for the duration of a record.
pub(super) const DURATION_KEYS: &[&str] =
    &["duration", "record length", "length of record", "total time", "length"];

/// Keywords for the peak acceleration.
pub(super) const PEAK_KEYS: &[&str] = &[
    "pga",
    "peak ground acceleration",
    "peak acceleration",
    "peak acc",
    "peak value",
    "max. acc.",
    "max. acc",
    "max acc",
    "maximum acceleration",
    "max acceleration",
];

/// Keywords for a component.
pub(super) const COMPONENT_KEYS: &[&str] =
    &["component", "comp.", "comp", "orientation", "direction", "azimuth", "channel"];

/// Words before a keyword that change its meaning.
pub(super) const OTHER_MEANING: &[&str] = &[
    "original",
    "orig",
    "raw",
    "significant",
    "bracketed",
    "effective",
    "uniform",
    "strong",
    "event",
    "pre-event",
    "post-event",
    "instrument",
];

/// Units of a sampling rate, as written after the number.
pub(super) const RATE_MARKS: &[&str] = &[
    "sps",
    "samples/sec",
    "samples/second",
    "samples/s",
    "samples per second",
    "samples per sec",
    "pts/sec",
    "muestras por segundo",
    "campioni al secondo",
    "amostras por segundo",
];

/// Beginnings of the word for acceleration in several languages.
pub(super) const ACCELERATIONS: &[&str] = &["acc", "acel", "beschl", "ivme"];
/// Beginnings of the word for velocity in several languages.
pub(super) const VELOCITIES: &[&str] = &["veloc", "vitess", "geschw"];
/// Beginnings of the word for displacement in several languages.
pub(super) const DISPLACEMENTS: &[&str] =
    &["displ", "desplaz", "deplac", "spostam", "verschieb", "deslocam", "yerdeg"];

/// Returns `true` for a unit of raw digitizer output, such as counts or volts. The conversion of such
/// values to accelerations needs a sensitivity.
pub(super) fn is_of_instrument(unit: &str) -> bool {
    const UNITS: &[&str] = &[
        "v", "mv", "uv", "volt", "volts", "lsb", "lsbs", "count", "counts", "cts", "adc", "digit",
        "digits", "bit", "bits", "ticks",
    ];
    UNITS.contains(&unit.trim().to_lowercase().as_str())
}

/// Beginnings of the word for "unit" in several languages.
pub(super) const UNIT_WORDS: &[&str] =
    &["unit", "unidad", "einheit", "satuan", "birim", "jednostk", "единиц", "单位"];

/// Parts of words that indicate a frequency other than the sampling rate.
pub(super) const OTHER_FREQUENCIES: &[&str] = &[
    "filt",
    "cut",
    "corner",
    "pass",
    "band",
    "corte",
    "esquina",
    "taglio",
    "coupure",
    "grenz",
    "nyquist",
    "natural",
    "natuerlich",
    "eigen",
    "propr",
    "sensor",
    "instrument",
    "response",
    "line",
    "clock",
    "usable",
];
