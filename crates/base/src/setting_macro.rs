//! The blocks in which settings are written down.

/// A section of settings: a struct, its defaults, how files give it, and a [`Row`](crate::Row) of each.
///
/// ```
/// strandline_base::settings! {
///     /// Drag of the air.
///     pub struct Drag: Copy {
///         /// Rate at which hair takes the velocity of wind across it.
///         across: f32 = 1.5, in [0.0, 1000.0] "1/s", slider [0.0, 20.0], more "hair follows the wind sooner";
///         /// Whether there is air.
///         enabled: bool = true;
///     }
/// }
/// use strandline_base::Group;
/// assert_eq!(Drag::ROWS.across.limits(), "0 to 1000 1/s");
/// assert!(Drag { across: f32::NAN, ..Drag::default() }.check_as("drag").is_err());
/// ```
///
/// A line is `name: Type = default`, then its properties in this order: `required true` for
/// a setting that a file must give, `in [least, most] "unit"`, `slider [least, most]`, `more "effect of a larger value"`.
/// * A number of a section that a file does not give keeps the default of the section *where it stands*: a
///   part of `springs.stretch` leaves the rest of the stretch spring as it is.
/// * `shared Other { name: Type }` are settings that another section states: default, range, unit and sentence are
///   those of `Other`.
/// * `overrides Other { name: Type }` are settings of `Other` that this section may replace: `Overrides::over`
///   merges those that are given into an `Other`. Each is an `Option`, absent by default.
/// * `plain { name: Type }` are fields that no file has; `moved { name: Type => "new.key" }` are keys of
///   old files: read by a section around this one in its `prepare`, refused elsewhere with the new key.
/// * After the struct, `prepare path;` names a `fn(&mut Self, &mut <Self as Value>::Given)`, or one that only
///   reads what is given. It runs before that is taken (for defaults that depend on it, and keys that moved).
///   `also path;` names a `fn(&Self, &Key) -> Result<(), SettingError>` for conditions beyond ranges.
#[macro_export]
macro_rules! settings {
    (
        $(#[doc = $about:literal])*
        pub struct $Name:ident $(: $Copy:ident)? {
            $(
                $(#[doc = $doc:literal])+
                $field:ident: $Type:ty = $default:expr
                $(, required $required:literal)?
                $(, in [$least:expr, $most:expr] $($unit:literal)?)?
                $(, slider [$left:expr, $right:expr])?
                $(, more $more:literal)?
                $(, invalidates $invalid:ident)?
                ;
            )*
            $(shared $Shared:ty { $($share:ident: $Share:ty),* $(,)? })*
            $(overrides $Base:ty { $($over:ident: $Over:ty),* $(,)? })*
            $(plain { $($(#[$plain_meta:meta])* $plain:ident: $Plain:ty),* $(,)? })?
            $(moved { $($moved:ident: $Moved:ty => $new_key:literal),* $(,)? })?
        }
        $(prepare $prepare:path;)?
        $(also $also:path;)?
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq, ::serde::Serialize $(, $Copy)?)]
        pub struct $Name {
            $(
                $(#[doc = $doc])+
                #[doc = ""]
                #[doc = concat!(
                    "Default `", stringify!($default), "`",
                    $("; range `", stringify!($least), "` to `", stringify!($most), "`", $(" ", $unit,)?)?
                    "."
                )]
                #[serde(skip_serializing_if = "::strandline_base::Value::is_absent")]
                pub $field: $Type,
            )*
            $($(
                #[doc = concat!("As [`", stringify!($Shared), "::", stringify!($share), "`].")]
                #[serde(skip_serializing_if = "::strandline_base::Value::is_absent")]
                pub $share: $Share,
            )*)*
            $($(
                #[doc = concat!("In place of [`", stringify!($Base), "::", stringify!($over), "`].")]
                #[serde(skip_serializing_if = "Option::is_none")]
                pub $over: Option<$Over>,
            )*)*
            $($(
                $(#[$plain_meta])*
                #[serde(skip)]
                pub $plain: $Plain,
            )*)?
        }

        const _: () = {
            /// The settings that a file gives.
            #[allow(missing_docs)]
            #[derive(Clone, Default)]
            pub struct Given {
                $(pub $field: Option<<$Type as $crate::Value>::Given>,)*
                $($(pub $share: Option<<$Share as $crate::Value>::Given>,)*)*
                $($(pub $over: Option<$Over>,)*)*
                $($(pub $moved: Option<$Moved>,)*)?
            }

            const FIELDS: &[&str] = &[
                $($crate::plain_name(stringify!($field)),)*
                $($($crate::plain_name(stringify!($share)),)*)*
                $($($crate::plain_name(stringify!($over)),)*)*
                $($($crate::plain_name(stringify!($moved)),)*)?
            ];
            struct Fields;
            impl<'de> ::serde::de::Visitor<'de> for Fields {
                type Value = Given;
                fn expecting(&self, to: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                    to.write_str("a section of settings")
                }

                #[allow(unused_assignments, unused_mut, unused_variables)]
                fn visit_map<A: ::serde::de::MapAccess<'de>>(self, mut map: A) -> Result<Given, A::Error> {
                    let mut given = Given::default();
                    while let Some(found) = map.next_key_seed($crate::FieldName(FIELDS))? {
                        let mut place = 0;
                        $($crate::settings!(@give given.$field, map, found, place);)*
                        $($($crate::settings!(@give given.$share, map, found, place);)*)*
                        $($($crate::settings!(@give given.$over, map, found, place);)*)*
                        $($($crate::settings!(@give given.$moved, map, found, place);)*)?
                    }
                    Ok(given)
                }
            }

            impl<'de> ::serde::Deserialize<'de> for Given {
                fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    deserializer.deserialize_struct("Given", FIELDS, Fields)
                }
            }

            /// The row of each setting.
            #[allow(missing_docs)]
            pub struct Rows {
                $(pub $field: $crate::Row,)*
                $($(pub $share: $crate::Row,)*)*
                $($(pub $over: $crate::Row,)*)*
            }

            impl $crate::Group for $Name {
                type Rows = Rows;
                const ROWS: Rows = Rows {
                    $($field: $crate::Row {
                        name: $crate::plain_name(stringify!($field)),
                        doc: concat!($($doc, "\n"),+),
                        kind: <$Type as $crate::Value>::KIND,
                        range: $crate::settings!(@ends $($least, $most)?),
                        unit: concat!($($($unit)?)?),
                        slider: $crate::settings!(@ends $($left, $right)?),
                        more: concat!($($more)?),
                        required: false $(|| $required)?,
                        invalidates: $crate::Invalidates {
                            $($invalid: true,)?
                            ..$crate::Invalidates::NOTHING
                        },
                    },)*
                    $($($share: <$Shared as $crate::Group>::ROWS.$share,)*)*
                    $($($over: $crate::Row {
                        required: false,
                        ..<$Base as $crate::Group>::ROWS.$over
                    },)*)*
                };
                const TABLE: $crate::Table = $crate::Table {
                    doc: concat!($($about, "\n"),*),
                    rows: &[
                        $(Self::ROWS.$field,)*
                        $($(Self::ROWS.$share,)*)*
                        $($(Self::ROWS.$over,)*)*
                    ],
                };
            }

            $(impl $crate::Overrides<$Base> for $Name {
                fn over(&self, base: &$Base) -> $Base {
                    let mut given = <<$Base as $crate::Value>::Given>::default();
                    $(given.$over = self.$over.clone();)*
                    let mut merged = base.clone();
                    $crate::Value::take(&mut merged, given);
                    merged
                }
            })*

            impl $crate::Value for $Name {
                type Given = Given;
                const KIND: $crate::Kind = $crate::Kind::Group(&<Self as $crate::Group>::TABLE);

                fn take(&mut self, given: Given) {
                    $(let mut given = given;
                    $prepare(self, &mut given);)?
                    $(if let Some(part) = given.$field {
                        $crate::Value::take(&mut self.$field, part);
                    })*
                    $($(if let Some(part) = given.$share {
                        $crate::Value::take(&mut self.$share, part);
                    })*)*
                    $($(if given.$over.is_some() {
                        self.$over = given.$over;
                    })*)*
                }

                fn check(&self, _: &$crate::Row, key: &$crate::Key) -> Result<(), $crate::SettingError> {
                    $($crate::Value::check(
                        &self.$field,
                        &<Self as $crate::Group>::ROWS.$field,
                        &key.of($crate::plain_name(stringify!($field))),
                    )?;)*
                    $($($crate::Value::check(
                        &self.$share,
                        &<Self as $crate::Group>::ROWS.$share,
                        &key.of($crate::plain_name(stringify!($share))),
                    )?;)*)*
                    $($($crate::Value::check(
                        &self.$over,
                        &<Self as $crate::Group>::ROWS.$over,
                        &key.of($crate::plain_name(stringify!($over))),
                    )?;)*)*
                    $($also(self, key)?;)?
                    Ok(())
                }

                fn change_to(&self, other: &Self, _: &$crate::Row) -> $crate::Invalidates {
                    let nothing = $crate::Invalidates::NOTHING;
                    let rows = <Self as $crate::Group>::ROWS;
                    nothing
                        $(.and($crate::Value::change_to(&self.$field, &other.$field, &rows.$field)))*
                        $($(.and($crate::Value::change_to(&self.$share, &other.$share, &rows.$share)))*)*
                        $($(.and($crate::Value::change_to(&self.$over, &other.$over, &rows.$over)))*)*
                }
            }

            impl Default for $Name {
                #[allow(unused_mut)]
                fn default() -> Self {
                    let mut fresh = Self {
                        $($field: $default,)*
                        $($($share: <$Shared>::default().$share,)*)*
                        $($($over: None,)*)*
                        $($($plain: Default::default(),)*)?
                    };
                    $($prepare(&mut fresh, &mut Given::default());)?
                    fresh
                }
            }

            impl<'de> ::serde::Deserialize<'de> for $Name {
                fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    let given = <Given as ::serde::Deserialize>::deserialize(deserializer)?;
                    $($(if given.$moved.is_some() {
                        let now = concat!("`", stringify!($moved), "` is now `", $new_key, "` of a scene");
                        return Err(<D::Error as ::serde::de::Error>::custom(now));
                    })*)?
                    $(if (false $(|| $required)?) && given.$field.is_none() {
                        return Err(<D::Error as ::serde::de::Error>::missing_field($crate::plain_name(stringify!($field))));
                    })*
                    $($(if <$Shared as $crate::Group>::ROWS.$share.required && given.$share.is_none() {
                        return Err(<D::Error as ::serde::de::Error>::missing_field($crate::plain_name(stringify!($share))));
                    })*)*
                    let mut value = Self::default();
                    $crate::Value::take(&mut value, given);
                    Ok(value)
                }
            }
        };
    };
    (@give $given:ident.$field:ident, $map:ident, $found:ident, $place:ident) => {
        if $found == $place {
            $given.$field = $map.next_value()?;
            continue;
        }
        $place += 1;
    };
    (@ends) => { None };
    (@ends $least:expr, $most:expr) => { Some([$least as f64, $most as f64]) };
}

/// A key of old files that no setting takes the place of. A section lists it under `moved` with this type, and a
/// file that names it is refused with what to write instead.
///
/// ```
/// strandline_base::gone! {
///     /// How far it once bent.
///     NoBend, "`bend` is gone: `stiffness` tells how far it bends"
/// }
/// assert!(toml::from_str::<NoBend>("bend = 3").is_err());
/// ```
#[macro_export]
macro_rules! gone {
    ($(#[doc = $about:literal])* $Name:ident, $message:literal) => {
        $(#[doc = $about])*
        #[derive(Clone, Copy, Debug)]
        pub struct $Name;

        impl<'de> ::serde::Deserialize<'de> for $Name {
            fn deserialize<D: ::serde::Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
                Err(<D::Error as ::serde::de::Error>::custom($message))
            }
        }
    };
}

/// An enum that a file names by a word: its words stand once. Words are read in capitals too, and a choice may have
/// further words that are read, behind `or`.
///
/// ```
/// strandline_base::choices! {
///     /// How light beyond white is shown.
///     pub enum ToneMap as "tone_map" {
///         /// Cut off at 1.
///         Off = "off",
///         /// Rolled off smoothly toward white.
///         Filmic = "filmic" or "soft",
///     }
///     default Filmic
/// }
/// assert_eq!("off".parse(), Ok(ToneMap::Off));
/// assert_eq!("Soft".parse(), Ok(ToneMap::Filmic));
/// assert_eq!(ToneMap::default().name(), "filmic");
/// ```
#[macro_export]
macro_rules! choices {
    (
        $(#[doc = $about:literal])*
        pub enum $Name:ident as $key:literal {
            $($(#[doc = $doc:literal])+ $Choice:ident = $word:literal $(or $other:literal)*),+ $(,)?
        }
        default $Default:ident
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, ::serde::Serialize)]
        pub enum $Name {
            $(
                $(#[doc = $doc])+
                #[serde(rename = $word)]
                $Choice,
            )+
        }

        impl $Name {
            /// Every one.
            pub const ALL: [Self; [$($word),+].len()] = [$(Self::$Choice),+];

            /// The choice of a word, in letters of either case.
            fn read(name: &str) -> Option<Self> {
                let is_named = |words: &[&str]| words.iter().any(|word| word.eq_ignore_ascii_case(name));
                $(if is_named(&[$word $(, $other)*]) {
                    return Some(Self::$Choice);
                })+
                None
            }

            /// Its name, as in scenes.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$Choice => $word,)+
                }
            }
        }

        impl Default for $Name {
            fn default() -> Self {
                Self::$Default
            }
        }

        impl ::std::str::FromStr for $Name {
            type Err = $crate::SettingError;

            fn from_str(name: &str) -> Result<Self, $crate::SettingError> {
                Self::read(name).ok_or_else(|| {
                    let expected = format!("one of {}", [$($word),+].join(", "));
                    $crate::SettingError::new($key, format!("`{name}`"), expected)
                })
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $Name {
            fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let name = <::std::borrow::Cow<'de, str> as ::serde::Deserialize>::deserialize(deserializer)?;
                Self::read(&name).ok_or_else(|| {
                    <D::Error as ::serde::de::Error>::unknown_variant(&name, &[$($word),+])
                })
            }
        }

        impl $crate::Value for $Name {
            type Given = Self;
            const KIND: $crate::Kind = $crate::Kind::Words(&[
                $($crate::Word::new($word, concat!($($doc, "\n"),+))),+
            ]);

            fn take(&mut self, given: Self) {
                *self = given;
            }

            fn check(&self, _: &$crate::Row, _: &$crate::Key) -> Result<(), $crate::SettingError> {
                Ok(())
            }
        }
    };
}
