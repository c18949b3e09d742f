//! The page around the blocks of a document: style sheet, scripts and their data.

use std::{collections::HashMap, fmt::Write as _};

use serde_json::{Value, json};

use crate::{
    Axis, Band, Language, Mark, Plot, Scale,
    escape::{self, json_in_script},
    language::markup::{texts_of_markup, texts_of_script},
    pack,
    style::{DASHES, PALETTE, STYLE, standalone_style},
    trial::{self, Trial},
};

const REPORT_CSS: &str = include_str!("../assets/report.css");
const UPLOT_CSS: &str = include_str!("../assets/vendor/uPlot.min.css");
const UPLOT_JS: &str = include_str!("../assets/vendor/uPlot.iife.min.js");
const UPLOT_LICENSE: &str = include_str!("../assets/vendor/uPlot-LICENSE");

/// three.js, reduced by `cargo xtask bundle` to the parts that the three-dimensional view of the player uses.
const THREE_JS: &str = include_str!("../assets/vendor/three.iife.min.js");
const THREE_LICENSE: &str = include_str!("../assets/vendor/three-LICENSE");

/// Scripts of the player, in the order of their dependencies.
const PLAYER: [&str; 15] = [
    include_str!("../assets/language.js"),
    include_str!("../assets/held.js"),
    include_str!("../assets/decode.js"),
    include_str!("../assets/forces.js"),
    include_str!("../assets/tint.js"),
    include_str!("../assets/callout.js"),
    include_str!("../assets/ghosts.js"),
    include_str!("../assets/stage.js"),
    include_str!("../assets/timeline.js"),
    include_str!("../assets/lens.js"),
    include_str!("../assets/moment.js"),
    include_str!("../assets/keys.js"),
    include_str!("../assets/views.js"),
    include_str!("../assets/link.js"),
    include_str!("../assets/player.js"),
];

/// Scripts of the three-dimensional view, for pages with a player.
const DEPTH: [&str; 3] = [
    include_str!("../assets/solids.js"),
    include_str!("../assets/orbit.js"),
    include_str!("../assets/deep.js"),
];

/// Scripts of a report, in addition to those of the player.
const REPORT: [&str; 2] = [include_str!("../assets/plots.js"), include_str!("../assets/page.js")];

/// Returns all scripts that may pass strings to the function `t`, which translates them.
#[cfg(test)]
pub(crate) fn all_scripts() -> impl Iterator<Item = &'static str> {
    PLAYER.into_iter().chain(DEPTH).chain(REPORT).chain([trial::SCRIPT])
}

/// Content security policy of a page. It forbids all URLs except `data:` and `blob:` URLs of images. The icon of the
/// page is an empty `data:` URL, so that a browser does not request an icon.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; \
                      img-src data: blob:";

/// Content security policy of a page with an embedded program. It allows the program to run, including in workers.
const PROGRAM_POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; \
                              script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; \
                              img-src data: blob:; base-uri 'none'; form-action 'none'";

/// Data for the scripts, collected while blocks are written.
#[derive(Default)]
pub(crate) struct Payload {
    pub(crate) players: Vec<Value>,
    pub(crate) plots: Vec<Value>,
    columns: Vec<Value>,
    known: HashMap<String, usize>,
}

impl Payload {
    /// Adds an interactive plot and returns its index.
    pub(crate) fn add_plot(&mut self, id: &str, plot: &Plot) -> usize {
        let series: Vec<Value> = plot
            .series
            .iter()
            .enumerate()
            .map(|(at, s)| {
                let count = s.x.len().min(s.y.len());
                // On a log axis small values are as visible as large ones, so values stay exact.
                let exact = plot.x.scale == Scale::Log || plot.y.scale == Scale::Log;
                let shown = |axis: &Axis, values: &[f64]| -> Vec<f64> {
                    values.iter().map(|v| if axis.shows(*v) { *v } else { f64::NAN }).collect()
                };
                let x = self.column(pack::column(&shown(&plot.x, &s.x[..count]), exact));
                let y = self.column(pack::column(&shown(&plot.y, &s.y[..count]), exact));
                json!({
                    "label": s.label,
                    "x": x,
                    "y": y,
                    "look": plot.look(at),
                    "dash": plot.dash(at),
                    "muted": s.style.muted,
                    "area": s.style.area,
                    "dots": s.style.dots,
                    "points": s.style.points,
                })
            })
            .collect();
        let marks = |list: &[Mark]| -> Vec<Mark> {
            list.iter().filter(|mark| mark.at.is_finite()).cloned().collect()
        };
        let shown = |band: &&Band| band.from.is_finite() && band.to.is_finite();
        let bands: Vec<&Band> = plot.bands.iter().filter(shown).collect();
        self.plots.push(json!({
            "id": id,
            "x": axis(&plot.x),
            "y": axis(&plot.y),
            "series": series,
            "marks": marks(&plot.marks),
            "levels": marks(&plot.levels),
            "bands": bands,
            "timeline": plot.timeline,
        }));
        self.plots.len() - 1
    }

    /// Stores a data column, unless an equal column is stored already, and returns its index.
    fn column(&mut self, column: Value) -> usize {
        let key = column.to_string();
        if let Some(&place) = self.known.get(&key) {
            return place;
        }
        self.columns.push(column);
        self.known.insert(key, self.columns.len() - 1);
        self.columns.len() - 1
    }

    /// Returns `true` if the scene of any player has three-dimensional data.
    fn has_depth(&self) -> bool {
        let mut panes =
            self.players.iter().filter_map(|player| player["panes"].as_array()).flatten();
        panes.any(|pane| pane["depth"].is_object())
    }

    /// Writes the data as JSON.
    pub(crate) fn into_json(self) -> String {
        json!({
            "players": self.players,
            "plots": self.plots,
            "columns": self.columns,
            "dashes": DASHES,
            "figureStyle": standalone_style(),
        })
        .to_string()
    }
}

fn axis(axis: &Axis) -> Value {
    let range =
        axis.range.filter(|[low, high]| axis.shows(*low) && axis.shows(*high) && low < high);
    json!({
        "title": axis.title(),
        "label": axis.label,
        "unit": axis.unit,
        "log": axis.scale == Scale::Log,
        "range": range,
    })
}

/// Assembles the HTML file of a report or of a single player from its body and `payload`. With `trial`, the file also
/// contains the embedded page.
pub(crate) fn assemble(
    (title, language): (&str, Language),
    body: &str,
    payload: Payload,
    trial: Option<&Trial<'_>>,
) -> String {
    let live = !payload.plots.is_empty();
    let deep = payload.has_depth();
    let played = trial.is_some() || !payload.players.is_empty();
    // Static tables and figures also need the scripts, which save and copy them.
    let scripted =
        live || played || ["<table", "<figure"].iter().any(|element| body.contains(element));
    let (policy, style) =
        if trial.is_some() { (PROGRAM_POLICY, trial::STYLE) } else { (POLICY, "") };
    let mut out = head((title, language), policy, if live { UPLOT_CSS } else { "" }, style);
    out.push_str(body);
    if scripted {
        hold(
            &mut out,
            "application/json",
            "barrelstack-data",
            &json_in_script(&payload.into_json()),
        );
    }
    if live {
        // The license requires its text to be included in every copy.
        let license = UPLOT_LICENSE.replace("*/", "* /");
        let _ = writeln!(out, "<script>\n/*\n{}\n*/\n{UPLOT_JS}\n</script>", license.trim());
    }
    if deep {
        let script = format!("/*\n{}\n*/\n{THREE_JS}", THREE_LICENSE.trim());
        hold(&mut out, "text/plain", "three", &pack::gzip_letters(script.as_bytes()));
    }
    if let Some(Trial { page, start }) = trial {
        hold(&mut out, "text/plain", "trial-page", &pack::gzip_letters(page.as_bytes()));
        hold(&mut out, "application/json", "trial-start", &json_in_script(start));
    }
    if scripted {
        let depth = DEPTH.into_iter().filter(|_| played);
        let tried = trial.map(|_| trial::SCRIPT);
        let scripts: Vec<&str> =
            PLAYER.into_iter().chain(depth).chain(REPORT).chain(tried).collect();
        hold_entries(&mut out, language, &scripts);
        out += &strict(&scripts.concat());
    }
    out.push_str("</body>\n</html>\n");
    out
}

/// Returns the file up to its body, with a content security policy, and with style sheets before
/// and after the common style sheet.
fn head((title, language): (&str, Language), policy: &str, before: &str, after: &str) -> String {
    let code = language.code();
    let title = escape::html(title);
    let palette = palette_css();
    format!(
        "<!doctype html>\n<html lang=\"{code}\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>{title}</title>\n<link rel=\"icon\" href=\"data:,\">\n\
         <style>\n{palette}{before}{STYLE}{REPORT_CSS}{after}</style>\n</head>\n<body>\n"
    )
}

/// A page with an embedded program, which has the same style and player as all other pages.
///
/// The policy of the page allows the embedded program to run, including in workers, and forbids every
/// request. Large data come last, after the scripts, so that the page is usable before the file is
/// fully loaded.
#[derive(Clone, Copy, Debug)]
pub struct Shell<'a> {
    /// Language of the page, to which its title, its body and the strings of its scripts are translated
    /// from English.
    pub language: Language,
    /// Title of the page.
    pub title: &'a str,
    /// Style sheet of the page.
    pub style: &'a str,
    /// Body of the page, as markup.
    pub body: &'a str,
    /// Data that are available when the scripts start: pairs of the id of an element and its content, which
    /// [`Shell::html`] compresses.
    pub at_hand: &'a [(&'a str, &'a [u8])],
    /// Script of the web workers, stored as text in the element with the id `worker`.
    pub worker: &'a str,
    /// Scripts of the page, which can access the scripts of the player.
    pub scripts: &'a [&'a str],
    /// Data that are loaded last: pairs of the id of an element and its content, which is already compressed with gzip.
    pub held: &'a [(&'a str, &'a [u8])],
}

impl Shell<'_> {
    /// Returns the page as an HTML file.
    pub fn html(&self) -> String {
        let Self { language, title, .. } = *self;
        let mut out = head((&language.text(title), language), PROGRAM_POLICY, "", self.style);
        out.push_str(&language.markup(self.body));
        for (id, bytes) in self.at_hand {
            hold(&mut out, "text/plain", id, &pack::gzip_letters(bytes));
        }
        hold(&mut out, "text/plain", "worker", &format!("\n{}", lean(self.worker)));
        hold_entries(&mut out, language, &self.all_scripts());
        let player: String = PLAYER.into_iter().chain(DEPTH).map(lean).collect();
        let own: String = self.scripts.iter().copied().map(lean).collect();
        // The scripts of the page are in a block of their own, so that their constants may have the same
        // names as those of the player.
        out += &strict(&format!("{player}{{\n{own}}}\n"));
        for (id, packed) in self.held {
            hold(&mut out, "text/plain", id, &pack::letters(packed));
        }
        out.push_str("</body>\n</html>\n");
        out
    }

    /// Returns the strings and parts of strings in the title, the body and the scripts that have no entry in the
    /// catalog of a language.
    pub fn untranslated(&self, language: Language) -> Vec<String> {
        let scripts = self.all_scripts();
        let texts = texts_of_markup(self.body).into_iter().chain([self.title.to_owned()]);
        let texts = texts
            .chain(scripts.iter().flat_map(|script| texts_of_script(script)).map(str::to_owned));
        texts.flat_map(|text| language.untranslated(&text)).collect()
    }

    /// Returns the scripts of the player and the scripts of the page.
    fn all_scripts(&self) -> Vec<&str> {
        PLAYER.into_iter().chain(DEPTH).chain(self.scripts.iter().copied()).collect()
    }
}

/// Writes the translations of the strings that `scripts` pass to their function `t`, as JSON in the element with the id
/// `language`; writes nothing for English.
fn hold_entries(out: &mut String, language: Language, scripts: &[&str]) {
    let entries = language.entries(scripts);
    if !entries.is_empty() {
        hold(out, "application/json", "language", &json_in_script(&json!(entries).to_string()));
    }
}

/// Wraps scripts in an element in which they have their own scope.
fn strict(scripts: &str) -> String {
    format!("<script>\n(() => {{\n\"use strict\";\n{scripts}}})();\n</script>\n")
}

/// Writes data for scripts into an element.
fn hold(out: &mut String, kind: &str, id: &str, text: &str) {
    // Writing to a String cannot fail.
    let _ = writeln!(out, "<script type=\"{kind}\" id=\"{id}\">{text}</script>");
}

/// Removes indentation, empty lines and comment lines from a script, which makes the script a fifth shorter. The
/// script must not contain multi-line strings.
fn lean(script: &str) -> String {
    let lines = script.lines().map(str::trim);
    let kept = lines.filter(|line| !line.is_empty() && !line.starts_with("//"));
    kept.flat_map(|line| [line, "\n"]).collect()
}

/// Returns the palette as CSS custom properties: light colors, or dark colors on screen if the
/// reader prefers them.
fn palette_css() -> String {
    let list = |pick: fn(&(&str, &str, &str)) -> String| -> String {
        PALETTE.iter().map(pick).collect::<Vec<_>>().join(";")
    };
    let light = list(|(name, light, _)| format!("--{name}:{light}"));
    let dark = list(|(name, _, dark)| format!("--{name}:{dark}"));
    format!(":root{{{light}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n")
}
