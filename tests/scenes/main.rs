//! Scenes in motion: those of Hirai by every method, contact, forces, and what is read from them.

mod common;

mod actuated;
mod auto;
mod beam_bend;
mod beam_jump;
mod checkpoint_file;
mod checkpoint_refused;
mod compression;
mod contact;
mod contact_events;
mod damping;
mod driving;
mod forces;
mod friction;
mod index_two;
mod indicators;
mod large;
mod moving_obstacles;
mod observer;
mod oscillating;
mod planes;
mod readings;
mod relaxing;
mod ring;
mod sensors;
mod simulation;
mod slips;
mod square_jump;
mod square_press;
mod start;
mod threads;
mod tunnelling;
mod turning;
mod varying;
mod warnings;
