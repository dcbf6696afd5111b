//! Hairs that a guide stands for.

use crate::sim::Settings;

/// Settings whose guides stand for a number of hairs in the air and in contacts unless they tell another.
pub(super) fn with_hairs(settings: &Settings, hairs: Option<f32>) -> Settings {
    let mut settings = settings.clone();
    settings.drag.hairs = settings.drag.hairs.or(hairs);
    settings.contact.hairs = settings.contact.hairs.or(hairs);
    settings
}
