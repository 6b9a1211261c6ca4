//! Tests of the pages whose commands render pictures and films.

mod readme;
mod tutorial;
