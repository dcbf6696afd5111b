//! The plain values that a setting can hold.

use std::fmt::{Display, LowerExp};
use std::path::PathBuf;

use glam::Vec3;

use crate::setting::Items;
use crate::{Group, Key, Kind, Row, SettingError, Value};
use serde::de::DeserializeOwned;

/// A number within the row's range, both ends taken. The ends are compared as numbers of the value's own
/// precision: 0.1 of 32 bits is more than 0.1 of 64.
trait Ranged: Copy {
    fn is_within(self, range: Option<[f64; 2]>) -> bool;
}

impl Ranged for f32 {
    fn is_within(self, range: Option<[f64; 2]>) -> bool {
        range.map_or(self.is_finite(), |[least, most]| (least as f32..=most as f32).contains(&self))
    }
}

impl Ranged for f64 {
    fn is_within(self, range: Option<[f64; 2]>) -> bool {
        range.map_or(self.is_finite(), |[least, most]| (least..=most).contains(&self))
    }
}

/// Whole numbers; without a range, as far as a file can write them.
macro_rules! whole {
    ($($Type:ty),*) => {$(
        impl Ranged for $Type {
            fn is_within(self, range: Option<[f64; 2]>) -> bool {
                match range {
                    Some([least, most]) => (least as $Type..=most as $Type).contains(&self),
                    None => i64::try_from(self).is_ok(),
                }
            }
        }
    )*};
}

whole!(u32, u64, usize);

/// Numbers as a file has them; without a page of zeros.
fn shown<N: Display + LowerExp>(components: &[N]) -> String {
    let one = |component: &N| {
        let text = component.to_string();
        if text.len() > 20 { format!("{component:e}") } else { text }
    };
    match components {
        [component] => one(component),
        several => format!("[{}]", several.iter().map(one).collect::<Vec<_>>().join(", ")),
    }
}

/// Numbers and lists of numbers.
macro_rules! numbers {
    ($($Type:ty: $kind:expr, |$value:ident| $components:expr;)*) => {$(
        impl Value for $Type {
            type Given = Self;
            const KIND: Kind = $kind;

            fn take(&mut self, given: Self) {
                *self = given;
            }

            fn check(&self, row: &Row, key: &Key) -> Result<(), SettingError> {
                let $value = self;
                if $components.iter().all(|component| component.is_within(row.range)) {
                    return Ok(());
                }
                Err(row.refuse(key, shown(&$components[..])))
            }
        }
    )*};
}

numbers! {
    f32: Kind::Number(1), |value| [*value];
    f64: Kind::Number(1), |value| [*value];
    u32: Kind::Whole(1), |value| [*value];
    u64: Kind::Whole(1), |value| [*value];
    usize: Kind::Whole(1), |value| [*value];
    Vec3: Kind::Number(3), |value| value.to_array();
    [f32; 3]: Kind::Number(3), |value| value;
    [u32; 3]: Kind::Whole(3), |value| value;
}

/// Values without limits.
macro_rules! free {
    ($($Type:ty: $kind:expr;)*) => {$(
        impl Value for $Type {
            type Given = Self;
            const KIND: Kind = $kind;

            fn take(&mut self, given: Self) {
                *self = given;
            }

            fn check(&self, _: &Row, _: &Key) -> Result<(), SettingError> {
                Ok(())
            }
        }
    )*};
}

free! {
    bool: Kind::Flag;
    PathBuf: Kind::Text("the path of a file");
    String: Kind::Text("a name");
}

impl<T: Value<Given = T> + Clone + DeserializeOwned> Value for Option<T> {
    type Given = T;
    const KIND: Kind = T::KIND;

    fn take(&mut self, given: T) {
        *self = Some(given);
    }

    fn check(&self, row: &Row, key: &Key) -> Result<(), SettingError> {
        self.as_ref().map_or(Ok(()), |value| value.check(row, key))
    }

    fn is_absent(&self) -> bool {
        self.is_none()
    }
}

impl<T: Group + Clone + DeserializeOwned> Value for Vec<T> {
    type Given = Self;
    const KIND: Kind = Kind::List(Items(|| &T::TABLE));

    fn take(&mut self, given: Self) {
        *self = given;
    }

    /// The range of a row is that of the number of items.
    fn check(&self, row: &Row, key: &Key) -> Result<(), SettingError> {
        if !self.len().is_within(row.range) {
            return Err(SettingError::new(key, format!("{} of them", self.len()), row.limits()));
        }
        self.iter().enumerate().try_for_each(|(index, item)| item.check(row, &key.at(index)))
    }
}
