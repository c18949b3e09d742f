//! Packed numbers for the page: quantized, differenced, and written as variable-length integers in base64.
//!
//! A value is rounded to a whole multiple of a quantum. The quantum is a power of two, so the product that the decoder
//! computes is exact, and page and program agree to the bit. The stream contains one LEB128 integer per value: 1 plus
//! the zigzag code of the first or second difference from the previous values. A sequence of `n` missing values is
//! encoded as two integers, 0 and `n - 1`.

use std::io::Write as _;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD as BASE64;
use flate2::{Compression, write::GzEncoder};
use serde_json::{Value, json};

/// Quantum of lengths (m) and angles (rad) of the frames: 2⁻¹⁴, about 0.061 mm and 0.061 mrad.
pub const POSE_QUANTUM: f64 = 1.0 / 16384.0;

/// Quantum of times (s): 2⁻²⁰, about 1 µs.
pub const TIME_QUANTUM: f64 = 1.0 / 1_048_576.0;

/// Largest multiple of the quantum that is stored; a larger value counts as missing. Second
/// differences of such numbers are exact in double precision.
const LIMIT: f64 = (1_u64 << 48) as f64;

/// Maximum number of values in a column that is always written as plain numbers. A longer column is packed, unless it
/// must be exact.
const PLAIN: usize = 512;

fn quantize(value: f64, quantum: f64) -> Option<i64> {
    let scaled = (value / quantum).round();
    // The bound keeps the conversion exact.
    #[expect(clippy::cast_possible_truncation, reason = "bounded by LIMIT")]
    (scaled.abs() <= LIMIT).then_some(scaled as i64)
}

/// Appends a channel to `out`, packed as first or second differences; `order` is 1 or 2.
fn pack_channel(values: impl Iterator<Item = Option<i64>>, order: u8, out: &mut Vec<u8>) {
    let (mut last, mut step) = (0_i64, 0_i64);
    let mut values = values.peekable();
    while let Some(value) = values.next() {
        let Some(value) = value else {
            let more = std::iter::from_fn(|| values.next_if(Option::is_none)).count();
            pack_integer(0, out);
            pack_integer(more as u64, out);
            continue;
        };
        let delta = value - last;
        let code = if order == 2 { delta - step } else { delta };
        (last, step) = (value, delta);
        pack_integer((code.wrapping_shl(1) ^ (code >> 63)).cast_unsigned() + 1, out);
    }
}

/// Appends an integer as LEB128 to `out`.
fn pack_integer(mut bits: u64, out: &mut Vec<u8>) {
    loop {
        let byte = u8::try_from(bits & 0x7f).unwrap_or(0);
        bits >>= 7;
        if bits == 0 {
            out.push(byte);
            break;
        }
        out.push(byte | 0x80);
    }
}

/// Packs channels one after the other, as first or second differences, whichever gives fewer bytes. Returns the order
/// of the differences (1 or 2) and the bytes.
fn pack(channels: &[Vec<Option<i64>>]) -> (u8, Vec<u8>) {
    let with = |order: u8| {
        let mut bytes = Vec::new();
        for channel in channels {
            pack_channel(channel.iter().copied(), order, &mut bytes);
        }
        bytes
    };
    let (first, second) = (with(1), with(2));
    if second.len() < first.len() { (2, second) } else { (1, first) }
}

/// Packs channels of equal length `count` with a common quantum.
pub(crate) fn channels(channels: &[Vec<f64>], count: usize, quantum: f64) -> Value {
    let whole: Vec<Vec<Option<i64>>> = channels
        .iter()
        .map(|channel| channel.iter().map(|v| quantize(*v, quantum)).collect())
        .collect();
    let (order, bytes) = pack(&whole);
    json!({ "q": quantum, "n": count, "c": channels.len(), "o": order, "d": BASE64.encode(&bytes) })
}

/// Writes a column: plain numbers if it is short or must be `exact`, otherwise packed.
///
/// The quantum of a packed column is at most 2⁻¹⁶ of its range, which is finer than any screen
/// resolution.
pub(crate) fn column(values: &[f64], exact: bool) -> Value {
    if exact || values.len() <= PLAIN {
        return Value::Array(
            values.iter().map(|v| if v.is_finite() { json!(v) } else { Value::Null }).collect(),
        );
    }
    channels(&[values.to_vec()], values.len(), quantum_for(values))
}

/// Returns a power of two that is at most 2⁻¹⁶ of the range of the finite values.
pub(crate) fn quantum_for(values: &[f64]) -> f64 {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let low = finite().fold(f64::INFINITY, f64::min);
    let high = finite().fold(f64::NEG_INFINITY, f64::max);
    let size = if high > low { high - low } else { high.abs() };
    // The bounds keep the quantum a normal number, and the multiples below LIMIT.
    if size.is_finite() && size > 1e-250 {
        let floor = high.abs().max(low.abs()) / LIMIT * 2.0;
        (size.log2().floor() - 16.0).exp2().max(floor.max(1e-300).log2().ceil().exp2())
    } else {
        1.0
    }
}

/// Encodes bytes in base64, to embed a file in text.
pub fn base64(bytes: &[u8]) -> String {
    BASE64.encode(bytes)
}

/// Compresses bytes with gzip and encodes them with [`letters`].
pub(crate) fn gzip_letters(bytes: &[u8]) -> String {
    let mut packer = GzEncoder::new(Vec::new(), Compression::best());
    // Writing to memory cannot fail.
    letters(&packer.write_all(bytes).and_then(|()| packer.finish()).unwrap_or_default())
}

/// Encodes bytes in base 85: the number of bytes, a space, and five characters for every four
/// bytes, most significant first.
///
/// The text is a sixteenth shorter than in base64. The alphabet starts at `!` and omits `<`, so the
/// text cannot end a script element.
pub(crate) fn letters(packed: &[u8]) -> String {
    let mut text = format!("{} ", packed.len());
    for four in packed.chunks(4) {
        let mut whole = [0; 4];
        whole[..four.len()].copy_from_slice(four);
        let number = u32::from_be_bytes(whole);
        for place in (0..5).rev() {
            let digit = u8::try_from(number / 85_u32.pow(place) % 85).unwrap_or(0);
            let letter = b'!' + digit;
            text.push(char::from(if letter >= b'<' { letter + 1 } else { letter }));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use super::*;

    fn unpack(value: &Value) -> Vec<f64> {
        let bytes = BASE64.decode(value["d"].as_str().unwrap()).unwrap();
        let (count, channels) = (value["n"].as_u64().unwrap(), value["c"].as_u64().unwrap());
        let (quantum, order) = (value["q"].as_f64().unwrap(), value["o"].as_u64().unwrap());
        let mut at = 0;
        let mut integer = || {
            let (mut bits, mut shift) = (0_u64, 0);
            loop {
                let byte = bytes[at];
                at += 1;
                bits |= u64::from(byte & 0x7f) << shift;
                shift += 7;
                if byte & 0x80 == 0 {
                    break bits;
                }
            }
        };
        let mut out = Vec::new();
        for _ in 0..channels {
            let (mut last, mut step) = (0_i64, 0_i64);
            let mut missing = 0;
            for _ in 0..count {
                let bits = if missing > 0 { 0 } else { integer() };
                if bits == 0 {
                    missing = if missing > 0 { missing - 1 } else { integer() };
                    out.push(f64::NAN);
                    continue;
                }
                let code = ((bits - 1) >> 1).cast_signed() ^ -(((bits - 1) & 1).cast_signed());
                step = if order == 2 { step + code } else { code };
                last += step;
                out.push(last as f64 * quantum);
            }
        }
        assert_eq!(at, bytes.len());
        out
    }

    #[test]
    fn packing_returns_every_value_within_half_a_quantum_and_gaps_as_gaps() {
        let mut values: Vec<f64> =
            (0..4000).map(|k| (f64::from(k) * 0.01).sin() * 3.0 - 100.0).collect();
        values[17] = f64::NAN;
        values[18] = f64::INFINITY;
        values[3000] = -1.0e4;
        let back = unpack(&channels(&[values.clone(), vec![0.0; 4000]], 4000, POSE_QUANTUM));
        for (value, back) in values.iter().zip(&back) {
            if value.is_finite() {
                assert!((value - back).abs() <= 0.5 * POSE_QUANTUM);
            } else {
                assert!(back.is_nan());
            }
        }
        assert!(back[4000..].iter().all(|v| *v == 0.0));
    }

    #[test]
    fn values_too_large_to_store_are_missing_and_never_wrong() {
        let back = unpack(&channels(&[vec![1.0, 1e30, -1e30, 2.0]], 4, POSE_QUANTUM));
        assert_eq!(back[0], 1.0);
        assert!(back[1].is_nan() && back[2].is_nan());
        assert_eq!(back[3], 2.0);
    }

    #[test]
    fn a_long_column_keeps_its_range_to_sixteen_bits() {
        for scale in [1e-12, 1.0, 1e9] {
            let values: Vec<f64> = (0..2000).map(|k| scale * f64::from(k % 701)).collect();
            let back = unpack(&column(&values, false));
            for (value, back) in values.iter().zip(&back) {
                assert!((value - back).abs() <= scale * 700.0 / 65536.0);
            }
        }
    }

    #[test]
    fn what_is_held_by_a_page_comes_back_and_ends_no_script() {
        for length in [0_u32, 1, 2, 3, 4, 5, 1000] {
            let bytes: Vec<u8> = (0..length)
                .flat_map(|k| (k * k).wrapping_mul(2_654_435_761).to_le_bytes())
                .collect();
            let text = gzip_letters(&bytes);
            assert!(!text.contains('<') && text.is_ascii());
            let (count, letters) = text.split_once(' ').unwrap();
            let digit = |letter: &u8| u32::from(letter - b'!' - u8::from(*letter > b'<'));
            let packed: Vec<u8> = letters
                .as_bytes()
                .chunks(5)
                .flat_map(|five| {
                    five.iter().fold(0_u32, |sum, letter| 85 * sum + digit(letter)).to_be_bytes()
                })
                .take(count.parse().unwrap())
                .collect();
            let mut back = Vec::new();
            flate2::read::GzDecoder::new(packed.as_slice()).read_to_end(&mut back).unwrap();
            assert_eq!(back, bytes);
        }
    }

    #[test]
    fn a_uniform_time_axis_costs_about_one_byte_a_sample() {
        let times: Vec<f64> = (0..3600).map(|k| f64::from(k) / 60.0).collect();
        let packed = channels(std::slice::from_ref(&times), times.len(), TIME_QUANTUM);
        assert!(packed["d"].as_str().unwrap().len() < 3600 * 4 / 3 + 16);
    }

    #[test]
    fn what_is_missing_for_long_costs_a_few_bytes() {
        // A body that is drawn in three of a thousand frames.
        let mut values = vec![f64::NAN; 1000];
        values[500..503].fill(1.0);
        let packed = channels(&[values.clone(), vec![f64::NAN; 1000]], 1000, POSE_QUANTUM);
        assert!(packed["d"].as_str().unwrap().len() < 24, "{packed}");
        let back = unpack(&packed);
        assert!(back[..1000].iter().zip(&values).all(|(a, b)| a.total_cmp(b).is_eq()));
        assert!(back[1000..].iter().all(|value| value.is_nan()));
    }
}
