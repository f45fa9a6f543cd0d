//! The analysis: the paper's logistic regression, and what an honest reader needs beside it.
//!
//! A [`table`] of subjects and a [`model`] make a [`design`]; a [`regression`] fits it by maximum likelihood and by
//! Firth's method, finds separation and aliases, and deletes each term in turn. docs/analysis.md says what each number is.

pub mod behaviour;
pub mod design;
pub mod differences;
pub mod exact;
pub mod firth;
pub mod fit;
pub mod folder;
pub mod json;
pub mod linear;
pub mod model;
pub mod newton;
pub mod noticed;
pub mod paired;
pub mod parallel;
pub mod power;
pub mod profile;
pub mod randomisation;
pub mod regression;
pub mod rows;
pub mod separation;
pub mod simplex;
pub mod study;
pub mod subjects;
pub mod table;
pub mod tails;
