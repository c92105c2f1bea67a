//! Studies that others published, run again: the models of Fig. 9 side by side, the spectra of Zhang and Makris (2001).

pub mod comparison;
pub mod overturning;
