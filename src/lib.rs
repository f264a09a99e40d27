pub mod dynamics;
mod lane;
pub mod physics;
