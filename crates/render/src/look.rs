use serde::{Deserialize, Serialize};

/// Colour and shape of the drawn hair.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Look {
    /// Follow strands of each guide, the guide itself among them.
    pub follow_strands: u32,
}

/// How detail falls with viewing distance [Chen2011 table 5].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LevelOfDetail {}
