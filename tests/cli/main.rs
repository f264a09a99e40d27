//! The program from outside: answers, files, bad input and exit codes.
#![cfg(feature = "app")]

mod best;
mod check;
mod fit;
mod man;
mod outputs;
mod probability;
mod simulate;
mod support;
mod trace;
mod tutorial;
