//! A section of settings: reading, checks, description.

use glam::Vec3;
use strandline_base::{Group, Key, Kind, Overrides, SettingError, Value, choices, settings};

choices! {
    /// A word.
    pub enum Way as "way" {
        /// This way.
        This = "this",
        /// That way.
        That = "that" or "other",
    }
    default That
}

settings! {
    /// A spring.
    pub struct Spring: Copy {
        /// Enables the pull.
        enabled: bool = true;
        /// Force \[over\] extension.
        stiffness: f32 = 1e-5, in [0.0, 0.1] "N/m", slider [0.0, 1e-4], more "stiffer";
    }
}

settings! {
    /// Two springs and more.
    pub struct Springs {
        /// The first.
        first: Spring = Spring { enabled: true, stiffness: 2e-5 };
        /// The second.
        second: Spring = Spring { enabled: false, stiffness: 3e-5 };
        /// A place.
        place: Vec3 = Vec3::X, required true, in [-1.0, 1.0] "m";
        /// A way.
        way: Way = Way::default();
        /// Number of items.
        count: [u32; 3] = [4; 3], in [4, 512];
        /// Others.
        others: Vec<Spring> = Vec::new(), in [0, 2];
        /// An optional time.
        time: Option<f64> = None, in [0.0, 1.0] "s";
        plain {
            /// In no file.
            folder: String,
        }
        moved { old: u32 => "elsewhere.old" }
    }
    prepare Springs::prepare;
    also Springs::rising;
}

impl Springs {
    /// The second spring of a file that goes this way is stiffer.
    fn prepare(&mut self, given: &<Self as Value>::Given) {
        if given.way == Some(Way::This) {
            self.second.stiffness = 9e-5;
        }
    }

    fn rising(&self, key: &Key) -> Result<(), SettingError> {
        if self.first.stiffness <= self.second.stiffness || self.second.enabled {
            return Ok(());
        }
        Err(SettingError::new(key.of("first"), "stiffer", "the weaker"))
    }
}

fn read(text: &str) -> Result<Springs, String> {
    toml::from_str(text).map_err(|error| error.to_string())
}

#[test]
fn what_a_file_leaves_out_stays_as_it_is_where_it_stands() {
    let springs = read("place = [0, 0, 0]\n[first]\nenabled = false\n").unwrap();
    assert_eq!(springs.first, Spring { enabled: false, stiffness: 2e-5 });
    assert_eq!(springs.second, Springs::default().second);
    let springs = read("place = [0, 0, 0]\nway = \"this\"\n[second]\nenabled = true\n").unwrap();
    assert_eq!(springs.second, Spring { enabled: true, stiffness: 9e-5 }, "its default depends on the way");
}

#[test]
fn what_no_file_may_say_is_refused() {
    let wrong = [
        ("", "missing field `place`"),
        ("place = [0, 0, 0]\nplaice = 1", "unknown field `plaice`"),
        ("place = [0, 0, 0]\nfolder = \"a\"", "unknown field `folder`"),
        ("place = [0, 0, 0]\nold = 3", "`old` is now `elsewhere.old`"),
        ("place = [0, 0, 0]\nway = \"third\"", "unknown variant `third`, expected `this` or `that`"),
        ("place = [0, 0, 0]\nfirst = 3", "expected a section of settings"),
    ];
    for (text, message) in wrong {
        let error = read(text).unwrap_err();
        assert!(error.contains(message), "{text}: {error}");
    }
}

#[test]
fn a_section_survives_the_way_through_a_file() {
    let springs = Springs { place: Vec3::Y, time: Some(0.5), ..Springs::default() };
    assert_eq!(read(&toml::to_string(&springs).unwrap()).unwrap(), springs);
    assert!(!toml::to_string(&Springs::default()).unwrap().contains("time"));
}

#[test]
fn both_ends_of_a_range_are_taken_and_nothing_beyond() {
    let refused = |change: fn(&mut Springs)| {
        let mut springs = Springs::default();
        change(&mut springs);
        springs.check_as("springs").err().map(|error| error.to_string())
    };
    // As numbers of 64 bits, 0.1 of 32 bits is more than 0.1.
    assert_eq!(refused(|springs| springs.second.stiffness = 0.1), None);
    let beyond = "springs.second.stiffness is 0.10000001, expected 0 to 0.1 N/m";
    assert_eq!(refused(|springs| springs.second.stiffness = 0.1_f32.next_up()).unwrap(), beyond);
    let place = "springs.place is [1, NaN, 0], expected 3 numbers of -1 to 1 m";
    assert_eq!(refused(|springs| springs.place.y = f32::NAN).unwrap(), place);
    let count = "springs.count is [4, 4, 513], expected 3 whole numbers of 4 to 512";
    assert_eq!(refused(|springs| springs.count[2] = 513).unwrap(), count);
    let time = "springs.time is -1, expected 0 to 1 s";
    assert_eq!(refused(|springs| springs.time = Some(-1.0)).unwrap(), time);
    let item = "springs.others[1].stiffness is -1, expected 0 to 0.1 N/m";
    let others = |count| vec![Spring { enabled: true, stiffness: 0.0 }; count];
    assert_eq!(others(2).len(), 2);
    let bad = Spring { stiffness: -1.0, ..Spring::default() };
    let springs = Springs { others: vec![Spring::default(), bad], ..Springs::default() };
    assert_eq!(springs.check_as("springs").unwrap_err().to_string(), item);
    let springs = Springs { others: others(3), ..Springs::default() };
    let error = springs.check_as("springs").unwrap_err().to_string();
    assert_eq!(error, "springs.others is 3 of them, expected 0 to 2");
    assert!(refused(|springs| springs.first.stiffness = 0.05).unwrap().contains("the weaker"));
}

#[test]
fn everything_is_known_of_a_setting() {
    let row = Springs::TABLE.row("second.stiffness").unwrap();
    assert_eq!(*row, Spring::ROWS.stiffness);
    assert_eq!(row.sentence(), "Force [over] extension.");
    assert_eq!((row.limits().as_str(), row.slider(), row.more), ("0 to 0.1 N/m", [0.0, 1e-4], "stiffer"));
    let required: Vec<&str> =
        Springs::TABLE.rows.iter().filter(|row| row.required).map(|row| row.name).collect();
    assert_eq!(required, ["place"]);
    assert!(matches!(Springs::ROWS.way.kind, Kind::Words(words) if words[1].name == "that"));
    assert_eq!(Springs::TABLE.row("second.colour"), None);
    assert_eq!(Springs::TABLE.about(), "Two springs and more.");
    let error = "up".parse::<Way>().unwrap_err().to_string();
    assert_eq!(error, "way is `up`, expected one of this, that");
}

settings! {
    /// Cloth.
    pub struct Cloth: Copy {
        /// Thickness.
        thickness: f32 = 1.0, in [0.1, 10.0] "mm", slider [0.5, 2.0], more "stiffer cloth";
        /// Shear stiffness.
        shear: Option<f32> = None, in [1.0, 9.0] "Pa";
        /// Weave.
        count: u32 = 12, required true, in [1, 40];
    }
    prepare Cloth::prepare;
}

impl Cloth {
    /// Thick cloth shears less.
    fn prepare(&mut self, given: &<Self as Value>::Given) {
        if given.thickness.is_some_and(|thickness| thickness > 5.0) {
            self.shear = Some(2.0);
        }
    }
}

settings! {
    /// A patch of other cloth.
    pub struct Patch {
        /// Its name.
        name: String = String::new(), required true;
        shared Cloth { count: u32 }
        overrides Cloth { thickness: f32, shear: f32 }
    }
}

#[test]
fn settings_that_override_others_have_their_rows_and_merge() {
    let (own, base) = (Patch::ROWS.thickness, Cloth::ROWS.thickness);
    assert_eq!(own, base);
    assert_eq!(Patch::ROWS.count, Cloth::ROWS.count);
    let names: Vec<_> = Patch::TABLE.rows.iter().map(|row| row.name).collect();
    assert_eq!(names, ["name", "count", "thickness", "shear"]);
    let cloth = Cloth { shear: Some(3.0), ..Cloth::default() };
    let patch: Patch = toml::from_str("name = 'a'\ncount = 3").unwrap();
    assert_eq!((patch.over(&cloth), patch.count, patch.thickness), (cloth, 3, None));
    assert_eq!(toml::to_string(&patch).unwrap(), "name = \"a\"\ncount = 3\n");
    let patch: Patch = toml::from_str("name = 'a'\ncount = 3\nthickness = 6.0").unwrap();
    // The base's own preparation counts, and its settings that are not overridden stay.
    let wanted = Cloth { thickness: 6.0, shear: Some(2.0), ..cloth };
    assert_eq!(patch.over(&cloth), wanted);
    assert_eq!(toml::from_str::<Patch>(&toml::to_string(&patch).unwrap()).unwrap(), patch);
    let refused = Patch { thickness: Some(11.0), ..patch.clone() }.check_as("patch").unwrap_err();
    assert_eq!(refused.to_string(), "patch.thickness is 11, expected 0.1 to 10 mm");
    let refused = Patch { count: 41, ..patch }.check_as("patch").unwrap_err();
    assert_eq!(refused.to_string(), "patch.count is 41, expected 1 to 40");
    assert!(toml::from_str::<Patch>("name = 'a'").unwrap_err().to_string().contains("missing field `count`"));
    assert_eq!(Patch::default().count, 12);
}

#[test]
fn words_are_read_in_either_case_and_by_their_other_names() {
    for (word, way) in [("this", Way::This), ("THIS", Way::This), ("That", Way::That), ("Other", Way::That)] {
        assert_eq!(word.parse(), Ok(way));
        let springs: Springs = toml::from_str(&format!("place = [0, 0, 0]\nway = \"{word}\"")).unwrap();
        assert_eq!(springs.way, way, "{word}");
    }
    assert_eq!(Way::That.name(), "that");
    let error = "those".parse::<Way>().unwrap_err().to_string();
    assert_eq!(error, "way is `those`, expected one of this, that");
    let error = toml::from_str::<Springs>("place = [0, 0, 0]\nway = \"those\"").unwrap_err().to_string();
    assert!(error.contains("unknown variant `those`, expected `this` or `that`"), "{error}");
}
