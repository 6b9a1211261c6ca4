//! Tests of the physics against closed forms and published values, for every integration method.
//!
//! Tests that loop over `METHODS` include every new method in this table; they need only its order p. Unless stated otherwise, a tolerance
//! is that of [`common::tolerance`].

mod atoms;
mod charges;
mod closed_forms;
mod coming_and_going;
mod common;
mod cones;
mod conservation;
mod contacts;
mod crowds;
mod curved;
mod dense;
mod energy;
mod events;
mod fields;
mod formulas;
mod friction;
mod gravitation;
mod groups;
mod guided;
mod heaps;
mod impacts;
mod joints;
mod laws;
mod order;
mod origin;
mod passing;
mod pulleys;
mod reactions;
mod rotation;
mod same_bits;
mod scenes;
mod springs;
mod stepped;
mod validation;
mod waking;
