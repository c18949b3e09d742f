//! Scenes and documents that the tests share, and a reader of the data of a page.

use std::io::Read as _;
use std::sync::Arc;

use barrelstack_report::{
    Block, ContactForce, Document, Event, EventKind, Frames, History, Player, Polyline, Role,
    Scene, SceneBody, Tone, Trace, Verdict,
};
use serde_json::Value;

/// Text that corrupts any output that does not escape it.
pub(crate) const HOSTILE: &str =
    "</script><!-- \"a\" 'b' & <i>c</i> ]]> | * _ ` \u{0} \u{7} 樽 🛢 \u{202e}";

pub(crate) fn document(blocks: Vec<Block>) -> Document {
    Document {
        title: "Three levels".into(),
        verdict: Verdict {
            headline: "The stack stands.".into(),
            sentences: vec!["It slid 2 cm.".into()],
            tone: Tone::Stands,
            ..Verdict::default()
        },
        blocks,
        provenance: vec![("program".into(), "test".into())],
        warnings: vec![],
        ..Document::default()
    }
}

/// `bodies` barrels on a ground of 200 m that swing for `frames` frames at 60 Hz.
pub(crate) fn scene(bodies: usize, frames: usize) -> Scene {
    let ground = Polyline::open(vec![[-100.0, 0.0], [100.0, 0.0]]);
    let mut list = vec![SceneBody::new("ground", Role::Ground, vec![ground])];
    list.extend((0..bodies).map(|k| SceneBody::barrel(format!("B{}", k + 1), 0.33)));
    let times: Vec<f64> = (0..frames).map(|k| k as f64 / 60.0).collect();
    // Phases and growing amplitudes keep the channels from packing better than real motion does.
    let pose = |t: f64, b: usize| {
        let phase = 0.7 * b as f64;
        let sway = 0.05 * (6.1 * t + phase).sin() + 0.02 * (23.7 * t + 2.0 * phase).sin();
        [0.7 * (b % 2) as f64 + sway, 0.5 + 0.9 * (b / 2) as f64 + 0.1 * sway * sway, -3.0 * sway]
    };
    let poses = times
        .iter()
        .map(|&t| {
            let mut all = vec![[0.2 * (1.3 * t).sin(), 0.0, 0.0]];
            all.extend((0..bodies).map(|b| pose(t, b)));
            all
        })
        .collect();
    let forces = times
        .iter()
        .map(|&t| {
            (0..2 * bodies)
                .map(|c| ContactForce {
                    x: pose(t, c / 2)[0],
                    z: pose(t, c / 2)[1] - 0.3,
                    fx: 400.0 * (31.0 * t + c as f64).sin(),
                    fz: 2600.0 + 900.0 * (17.0 * t + c as f64).sin(),
                })
                .collect()
        })
        .collect();
    let history = History {
        label: "ground acceleration".into(),
        unit: "g".into(),
        times: times.clone(),
        values: times.iter().map(|t| 0.3 * (9.0 * t).sin()).collect(),
    };
    let events =
        vec![Event { time: 0.1, body: Some(1), kind: EventKind::Fall, text: "B1 falls".into() }];
    let frames = Frames { times, poses, forces };
    Scene { bodies: list, frames, events, ground: vec![history], ..Scene::default() }
}

pub(crate) fn player(scene: Scene) -> Block {
    Block::Player(Player {
        id: "player".into(),
        caption: "A run.".into(),
        scene: Arc::new(scene),
        traces: vec![Trace { body: 1, point: [0.0, 0.0], label: "center of B1".into() }],
    })
}

/// Returns the JSON data of a page.
pub(crate) fn payload(page: &str) -> Value {
    let open = "<script type=\"application/json\" id=\"barrelstack-data\">";
    let from = page.find(open).expect("the page carries data") + open.len();
    let to = from + page[from..].find("</script>").unwrap();
    serde_json::from_str(&page[from..to]).unwrap()
}

fn bytes(text: &str) -> Vec<u8> {
    const DIGITS: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = Vec::new();
    let (mut bits, mut held) = (0_u32, 0);
    for c in text.chars().filter(|c| *c != '=') {
        bits = bits << 6 | u32::try_from(DIGITS.find(c).unwrap()).unwrap();
        held += 6;
        if held >= 8 {
            held -= 8;
            out.push(u8::try_from(bits >> held & 0xff).unwrap());
        }
    }
    out
}

/// Equivalent of `unpack` in `decode.js`, in the same doubles: one list for each channel.
pub(crate) fn unpack(packed: &Value) -> Vec<Vec<f64>> {
    let bytes = bytes(packed["d"].as_str().unwrap());
    let whole = |key: &str| usize::try_from(packed[key].as_u64().unwrap()).unwrap();
    let (quantum, second) = (packed["q"].as_f64().unwrap(), whole("o") == 2);
    let mut at = 0;
    let mut integer = || {
        let (mut bits, mut weight) = (0.0_f64, 1.0);
        loop {
            let byte = bytes[at];
            at += 1;
            bits += f64::from(byte & 0x7f) * weight;
            weight *= 128.0;
            if byte & 0x80 == 0 {
                break bits;
            }
        }
    };
    let channels = (0..whole("c"))
        .map(|_| {
            let (mut last, mut step, mut missing) = (0.0_f64, 0.0_f64, 0.0);
            (0..whole("n"))
                .map(|_| {
                    let bits = if missing > 0.0 { 0.0 } else { integer() };
                    if bits == 0.0 {
                        missing = if missing > 0.0 { missing - 1.0 } else { integer() };
                        return f64::NAN;
                    }
                    let bits = bits - 1.0;
                    let code = if bits % 2.0 == 0.0 { bits / 2.0 } else { -(bits + 1.0) / 2.0 };
                    step = if second { step + code } else { code };
                    last += step;
                    last * quantum
                })
                .collect()
        })
        .collect();
    assert_eq!(at, bytes.len(), "the stream ends with its last value");
    channels
}

/// A VTK file, read by a parser of its own: the markup, and the block of all arrays.
pub(crate) struct Vtk {
    markup: String,
    arrays: Vec<u8>,
}

impl Vtk {
    pub(crate) fn of(file: &[u8]) -> Self {
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let end = b"\n</AppendedData>\n</VTKFile>\n";
        let at = file.windows(mark.len()).position(|part| part == mark).unwrap();
        let markup = format!("{}</VTKFile>", std::str::from_utf8(&file[..at]).unwrap());
        let arrays = file[at + mark.len()..].strip_suffix(end).unwrap().to_vec();
        Self { markup, arrays }
    }

    fn tree(&self) -> roxmltree::Document<'_> {
        roxmltree::Document::parse(&self.markup).unwrap()
    }

    /// Returns an attribute of the piece.
    pub(crate) fn count(&self, what: &str) -> usize {
        let tree = self.tree();
        let piece = tree.descendants().find(|node| node.has_tag_name("Piece")).unwrap();
        piece.attribute(what).unwrap().parse().unwrap()
    }

    /// Returns the bytes of an array: one block, whose sizes are in its header.
    fn bytes(&self, group: &str, name: &str, kind: &str) -> Vec<u8> {
        let tree = self.tree();
        let group = tree.descendants().find(|node| node.has_tag_name(group)).unwrap();
        let node = group.children().find(|node| node.attribute("Name") == Some(name)).unwrap();
        assert_eq!(node.attribute("type"), Some(kind), "{name}");
        assert_eq!(node.attribute("format"), Some("appended"));
        let at: usize = node.attribute("offset").unwrap().parse().unwrap();
        let number = |k: usize| {
            let word = &self.arrays[at + 4 * k..at + 4 * k + 4];
            u32::from_le_bytes(word.try_into().unwrap()) as usize
        };
        if number(0) == 0 {
            return Vec::new();
        }
        let mut unpacked = Vec::new();
        let packed = &self.arrays[at + 16..at + 16 + number(3)];
        flate2::read::ZlibDecoder::new(packed).read_to_end(&mut unpacked).unwrap();
        assert_eq!([number(0), number(1), number(2)], [1, unpacked.len(), 0]);
        unpacked
    }

    pub(crate) fn vectors(&self, group: &str, name: &str) -> Vec<[f32; 3]> {
        let bytes = self.bytes(group, name, "Float32");
        let numbers: Vec<f32> =
            bytes.as_chunks().0.iter().map(|word| f32::from_le_bytes(*word)).collect();
        numbers.as_chunks().0.to_vec()
    }

    pub(crate) fn whole(&self, group: &str, name: &str) -> Vec<usize> {
        let bytes = self.bytes(group, name, "Int32");
        let words = bytes.as_chunks().0.iter();
        words.map(|word| usize::try_from(i32::from_le_bytes(*word)).unwrap()).collect()
    }
}
