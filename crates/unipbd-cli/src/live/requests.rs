//! Requests of viewers to a run between two frames.

use foxglove::websocket::{AnyClient, GetParametersResponder, Parameter, SetParametersResponder};

/// Requests that wait for the run at most; further ones are refused.
const MOST: usize = 1000;

/// One request, with the way to answer it.
pub enum Request {
    /// Parameters are to change.
    Set { values: Vec<Parameter>, client: AnyClient, responder: SetParametersResponder },
    /// Parameters are to be told; no names mean all.
    Get { names: Vec<String>, responder: GetParametersResponder },
    /// The controls were used: others are to be told.
    Controlled,
}

/// Requests in the order in which they came.
#[derive(Default)]
pub struct Requests(Vec<Request>);

impl Requests {
    /// Adds a request; one too many is dropped, which tells its viewer.
    pub fn push(&mut self, request: Request) {
        if self.0.len() < MOST {
            self.0.push(request);
        }
    }

    /// Takes all.
    pub fn take(&mut self) -> Vec<Request> {
        std::mem::take(&mut self.0)
    }
}
