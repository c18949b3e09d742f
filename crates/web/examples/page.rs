//! Writes the page that contains the program: `page FOLDER TITLE LANGUAGE MODULE FILE`.
//!
//! The folder contains the body (`page.html`), the style sheet (`page.css`), the scripts (`*.js`,
//! of which `main.js` is last), and the script of the workers (`worker.js`). The answers of the
//! engine for the first stack are computed here and embedded, so that the page shows the stack
//! before the engine has started.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use barrelstack::scenario::builtin;
use barrelstack_report::{Language, Shell};
use barrelstack_web::{Request, RequestKind, answered};
use serde_json::{Value, json};

/// The first scenario of the page.
const FIRST: &str = "demo-napa";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [folder, title, language, module, file] = words.as_slice() else {
        return Err("expected: page FOLDER TITLE LANGUAGE MODULE FILE".into());
    };
    let language = language.parse()?;
    let folder = PathBuf::from(folder);
    let text = |name: &str| {
        let path = folder.join(name);
        std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
    };
    let mut names = Vec::new();
    for entry in std::fs::read_dir(&folder)? {
        names.push(entry?.file_name().to_string_lossy().into_owned());
    }
    let is_script = |name: &String| Path::new(name).extension().is_some_and(|end| end == "js");
    names.retain(|name| is_script(name) && name != "worker.js");
    names.sort_by_key(|name| (name == "main.js", name.clone()));
    let scripts = names.iter().map(|name| text(name)).collect::<Result<Vec<String>, _>>()?;
    let first = first(language)?.to_string();
    let (style, body, worker) = (text("page.css")?, text("page.html")?, text("worker.js")?);
    let module = packed(&std::fs::read(module)?)?;
    let page = Shell {
        language,
        title,
        style: &style,
        body: &body,
        at_hand: &[("first", first.as_bytes())],
        worker: &worker,
        scripts: &scripts.iter().map(String::as_str).collect::<Vec<_>>(),
        held: &[("engine", &module)],
    };
    std::fs::write(file, page.html())?;
    Ok(())
}

/// Compresses bytes with gzip at the highest level.
fn packed(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut packed = Vec::new();
    zopfli::compress(zopfli::Options::default(), zopfli::Format::Gzip, bytes, &mut packed)?;
    Ok(packed)
}

/// Returns the answers of the engine for the first stack in a language, and the catalog.
fn first(language: Language) -> Result<Value, Box<dyn std::error::Error>> {
    let scenario = builtin::get(FIRST).ok_or("the first scenario is missing")?;
    let answer_to = |kind| -> Result<Value, Box<dyn std::error::Error>> {
        let request = Request {
            name: format!("{FIRST}.toml"),
            language: language.code().to_owned(),
            ..Request::of(kind, scenario)
        };
        let answer = answered(&request.to_bytes(&[]), &mut |_, _| ControlFlow::Continue(()))?;
        Ok(serde_json::from_slice(&answer)?)
    };
    Ok(json!({
        "name": FIRST,
        "text": scenario,
        "catalog": answer_to(RequestKind::Catalog)?,
        "look": answer_to(RequestKind::Look)?,
    }))
}
