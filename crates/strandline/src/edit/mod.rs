//! Editing of scenes by a person, without a window: undo and redo, looks as files, settings found by name, numbers with
//! units, the mends that messages name.

mod changes;
mod history;
mod items;
mod look_file;
mod mends;
mod search;
mod units;

pub use changes::{changes, difference};
pub use history::{History, Step};
pub use items::{items_of, with_item, without_item};
pub use look_file::{is_look, load_look, save_look};
pub use mends::{Mend, mends};
pub use search::{SettingMatch, Values, find, settings_of, with_value};
pub use toml::{Table, Value};
pub use units::quantity;
