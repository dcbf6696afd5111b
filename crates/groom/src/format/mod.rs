//! Readers and writers of groom files.
