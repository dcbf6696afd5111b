//! The typed path of a file, with names that complete it.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Key, TextEdit, Ui, accesskit::Role};
use strandline::{format::Format, mesh::MeshFormat};

use crate::{App, controls::button};

/// Entries of a folder that are looked at, and names that are offered.
const LOOKED_AT: usize = 4000;
const MOST: usize = 8;

/// Paths that begin with a text: folders, which end with a slash, and files that the window opens, in the order of their
/// names.
pub fn completions(text: &str) -> Vec<String> {
    let (folder, start) = text.rsplit_once('/').map_or(("", text), |(folder, start)| (folder, start));
    let shown = if text.contains('/') { format!("{folder}/") } else { String::new() };
    if text.is_empty() {
        return Vec::new();
    }
    let place = if shown.is_empty() { PathBuf::from(".") } else { PathBuf::from(&shown) };
    let Ok(entries) = std::fs::read_dir(place) else { return Vec::new() };
    let start = start.to_lowercase();
    let mut found: Vec<String> = entries
        .take(LOOKED_AT)
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let fits =
                name.to_lowercase().starts_with(&start) && (!name.starts_with('.') || start.starts_with('.'));
            let path = entry.path();
            let is_folder = path.is_dir();
            (fits && (is_folder || opens(&path)))
                .then(|| format!("{shown}{name}{}", if is_folder { "/" } else { "" }))
        })
        .collect();
    found.sort();
    found.truncate(MOST);
    found.retain(|path| path != text);
    found
}

/// True for files that the window opens, by their endings.
fn opens(file: &Path) -> bool {
    strandline::scene::is_file(file) || Format::is_of(file) || MeshFormat::is_of(file)
}

/// The longest beginning that all of the completions have.
fn common(completions: &[String]) -> Option<String> {
    let first = completions.first()?;
    let ends = first.char_indices().map(|(at, character)| at + character.len_utf8());
    let shared = ends.rev().find(|end| completions.iter().all(|other| other.starts_with(&first[..*end])))?;
    Some(first[..shared].to_owned())
}

/// The path that is typed, and what completes it.
#[derive(Default)]
pub struct Typed {
    path: String,
    /// The text that completions were looked up for, those, and true while they are shown.
    asked: String,
    offered: Vec<String>,
    is_open: bool,
}

impl Typed {
    /// Looks completions up where the text has changed.
    fn look_up(&mut self) {
        if self.asked != self.path {
            self.asked.clone_from(&self.path);
            self.offered = completions(self.path.trim());
        }
    }

    /// Completes the path by what all completions have in common, else by the first of them.
    fn complete(&mut self) {
        let longer = common(&self.offered).filter(|common| common.len() > self.path.len());
        if let Some(path) = longer.or_else(|| self.offered.first().cloned()) {
            self.path = path;
            self.look_up();
        }
    }
}

/// The field with its completions; Tab takes what they have in common, Enter loads the file.
pub fn show(app: &mut App, ui: &mut Ui) {
    let mut wanted = None;
    let typed = &mut app.typed;
    ui.horizontal(|ui| {
        typed.look_up();
        let field = TextEdit::singleline(&mut typed.path).hint_text("path of a file").desired_width(180.0);
        let response = ui.add(field.lock_focus(!typed.offered.is_empty()));
        response.widget_info(|| egui::WidgetInfo::labeled(Role::TextInput, true, "path of a file"));
        let tabbed = response.has_focus() && ui.input(|input| input.key_pressed(Key::Tab));
        if response.changed() {
            typed.is_open = true;
            typed.look_up();
        }
        if tabbed && !typed.offered.is_empty() {
            typed.complete();
            to_end(ui, response.id, &typed.path);
        }
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        response.on_hover_text("path of a scene, groom or body; Tab completes it\ndefault none");
        if button(ui, "Load", "loads the file") || entered {
            wanted = Some(typed.path.trim().to_owned());
        }
    });
    let offered = if typed.is_open { typed.offered.clone() } else { Vec::new() };
    for path in &offered {
        let (folder, name) = path.trim_end_matches('/').rsplit_once('/').unwrap_or(("", path));
        let name = format!("{name}{}", if path.len() > folder.len() + name.len() + 1 { "/" } else { "" });
        if ui.small_button(name).on_hover_text(path).clicked() {
            typed.path.clone_from(path);
            typed.look_up();
            wanted = (!path.ends_with('/')).then(|| path.clone());
        }
    }
    match wanted {
        Some(path) if path.is_empty() => {
            app.note("type the path of a file first, or drop one on the window".to_owned());
        }
        Some(path) => {
            app.typed.is_open = false;
            app.open_file(&PathBuf::from(path));
        }
        None => {}
    }
}

/// Puts the cursor of a field behind its text.
fn to_end(ui: &Ui, id: egui::Id, text: &str) {
    if let Some(mut state) = TextEdit::load_state(ui.ctx(), id) {
        let end = egui::text::CCursor::new(text.chars().count());
        state.cursor.set_char_range(Some(egui::text::CCursorRange::one(end)));
        state.store(ui.ctx(), id);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_completed_by_folders_and_files_that_open() {
        let folder = tempfile::tempdir().unwrap();
        let base = folder.path().to_str().unwrap();
        std::fs::create_dir(folder.path().join("grooms")).unwrap();
        for name in ["wavy.hair", "wax.obj", "notes.txt", ".hidden.hair", "Waves.toml"] {
            std::fs::write(folder.path().join(name), b"").unwrap();
        }
        let names = |text: &str| completions(&format!("{base}/{text}"));
        assert_eq!(names("wa"), ["Waves.toml", "wavy.hair", "wax.obj"].map(|name| format!("{base}/{name}")));
        assert_eq!(names("gr"), [format!("{base}/grooms/")]);
        assert_eq!(names(".h"), [format!("{base}/.hidden.hair")]);
        assert!(names("notes").is_empty() && names("wavy.hair").is_empty() && completions("").is_empty());
        assert_eq!(common(&["a/wavy".to_owned(), "a/wax".to_owned()]).as_deref(), Some("a/wa"));
        assert_eq!(common(&["ä".to_owned(), "ö".to_owned()]), None);
        assert!(completions("/nowhere/at/all").is_empty());
    }
}
