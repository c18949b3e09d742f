//! Writes a page that holds a program: `shell MODULE FOLDER TITLE FILE`.
//!
//! The folder has the body (`page.html`), the style sheet (`page.css`), the scripts (`*.js`, of which `main.js` comes
//! last), and what its workers run (`worker.js`).

use std::path::{Path, PathBuf};

use barrelstack_report::Shell;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [module, folder, title, file] = words.as_slice() else {
        return Err("expected: shell MODULE FOLDER TITLE FILE".into());
    };
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
    let (style, body, worker) = (text("page.css")?, text("page.html")?, text("worker.js")?);
    let module = std::fs::read(module)?;
    let page = Shell {
        title,
        style: &style,
        body: &body,
        held: &[("engine", &module), ("worker", worker.as_bytes())],
        scripts: &scripts.iter().map(String::as_str).collect::<Vec<_>>(),
    };
    std::fs::write(file, page.html())?;
    Ok(())
}
