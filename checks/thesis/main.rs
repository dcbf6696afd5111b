//! thesis
