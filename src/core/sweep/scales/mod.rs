//! The units of the elastic contact, in which figures may be drawn: no part of the results.

pub mod elastic;
