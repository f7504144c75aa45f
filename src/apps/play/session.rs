//! The scene as it is played: time, and the actions of a hand.
//!
//! A frame is sent when the page has drawn the one before, so that a slow browser or a slow scene delays
//! nobody else and no queue builds up.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};

use serde_json::{Value, json};

use super::frame::{self, Present};
use super::hand::Hand;
use super::message::Message;
use super::pace::Pace;
use super::past::Past;
use super::record::{Original, Record};
use super::slider::Slider;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::simulate::{Checkpoint, Sampling, Simulation};
use crate::io::output::Picture;
use crate::scene::settings::Settings;
use crate::scene::timeline::Scene;

/// Part of the scene's duration, and time (s), after which the past is recorded at the latest.
const FINE: f64 = 1e-3;
const LONGEST: f64 = 5e-3;

/// A request to the simulation.
pub(super) enum Request {
    /// A message, and the channel for its answer.
    Message(Message, Sender<Value>),
    /// A browser is gone; whether it was the last one.
    Gone { was_last: bool },
}

/// A scene that is played.
pub(super) struct Session {
    simulation: Simulation,
    picture: Picture,
    sliders: Vec<Slider>,
    hand: Option<Hand>,
    playing: bool,
    pace: Pace,
    past: Past,
    /// Reason for which time has stopped.
    trouble: Option<String>,
    start: Checkpoint,
    record: Record,
    /// The file of the scene, if it has one.
    pub(super) original: Option<Original>,
}

impl Session {
    /// A session of `scene` at its start, and its data that do not change, for the page.
    pub(super) fn new(scene: &Scene, settings: &Settings) -> Result<(Self, Value), Error> {
        let mut simulation = scene.start(settings)?;
        let (picture, mut fixed) = Picture::new(scene)?;
        let sliders = Slider::all(scene);
        fixed["start"] = picture.places(scene.body().mesh(), simulation.view().displacements());
        fixed["sliders"] = sliders.iter().map(Slider::to_json).collect();
        fixed["sensors"] = json!([]);
        fixed["until"] = scene.end().into();
        fixed["mesh"] = frame::mesh(scene);
        fixed["solver"] = json!({ "rtol": format!("{:e}", settings.rtol) });
        let session = Self {
            picture,
            sliders,
            hand: None,
            playing: false,
            pace: Pace::new(),
            past: Past::of(&mut simulation),
            trouble: None,
            record: Record::default(),
            original: None,
            start: simulation.checkpoint(),
            simulation,
        };
        Ok((session, fixed))
    }

    /// Reads the sensors of `sampling` from the start on. Returns their names and units, for the page.
    pub(super) fn read(&mut self, sampling: &Sampling) -> Result<Value, InputError> {
        self.simulation.record(sampling)?;
        self.start = self.simulation.checkpoint();
        self.past = Past::of(&mut self.simulation);
        let sensors = self.simulation.trajectory().sensors().iter();
        Ok(sensors.map(|sensor| json!({ "name": sensor.name, "unit": sensor.unit })).collect())
    }

    /// Plays until all senders of requests are gone.
    pub(super) fn run(mut self, requests: &Receiver<Request>) {
        loop {
            let request = match self.playing {
                true => requests.recv_timeout(self.pace.wait()),
                false => requests.recv().map_err(RecvTimeoutError::from),
            };
            match request {
                Ok(request) => self.serve(request),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            while let Ok(request) = requests.try_recv() {
                self.serve(request);
            }
            if self.playing && self.pace.wait().is_zero() {
                self.advance();
            }
        }
    }

    fn serve(&mut self, request: Request) {
        match request {
            Request::Message(message, answers) => {
                let answer = self.answer(message).unwrap_or_else(|error| error_answer(&error));
                // a page that is gone needs no answer
                let _ = answers.send(answer);
            }
            Request::Gone { was_last } => {
                if let Err(error) = self.let_go() {
                    self.stop(&error);
                }
                self.playing &= !was_last;
            }
        }
    }

    fn answer(&mut self, message: Message) -> Result<Value, String> {
        let done = match message {
            Message::Look { colours, since } => {
                return Ok(json!({ "frame": self.frame(colours, since) }));
            }
            Message::Save => {
                let original = self.original.as_ref().ok_or("the scene has no file")?;
                let text = self.record.saved(self.simulation.scene(), original)?;
                return Ok(json!({ "file": text }));
            }
            Message::Play => self.play(),
            Message::Pause => {
                self.playing = false;
                Ok(())
            }
            Message::Start => self.go_back(),
            Message::Speed(speed) => {
                self.pace.speed = speed;
                Ok(())
            }
            Message::Slide(number, value) => self.slide(number, value),
            Message::Pull { place, to, strength } => return self.pull(place, to, strength),
            Message::LetGo => self.let_go(),
        };
        done.map(|()| json!({ "done": true })).map_err(|error| error.to_string())
    }

    fn frame(&self, colours: Option<usize>, since: Option<f64>) -> Value {
        let present = Present {
            simulation: &self.simulation,
            picture: &self.picture,
            sliders: &self.sliders,
            hand: self.hand.as_ref(),
            pace: &self.pace,
            past: &self.past,
            playing: self.playing,
            trouble: self.trouble.as_deref(),
        };
        frame::of(&present, colours, since)
    }

    fn play(&mut self) -> Result<(), Error> {
        if self.simulation.time() >= self.simulation.scene().end() {
            self.go_back()?;
        }
        self.trouble = None;
        if !self.playing {
            self.pace.start();
        }
        self.playing = true;
        Ok(())
    }

    fn go_back(&mut self) -> Result<(), Error> {
        self.simulation.restore(&self.start)?;
        (self.hand, self.trouble, self.record) = (None, None, Record::default());
        self.past = Past::of(&mut self.simulation);
        self.pace.start();
        Ok(())
    }

    fn slide(&mut self, number: usize, value: f64) -> Result<(), Error> {
        let slider = self.sliders.get(number).ok_or_else(|| {
            let help = format!("there are {} sliders, counted from 0", self.sliders.len());
            InputError::new("slider", number, help)
        })?;
        self.simulation.check_goes_on()?;
        let (scene, t) = (self.simulation.scene(), self.simulation.time());
        let input = self.record.moved(scene, &slider.target, t, value);
        self.simulation.set(input)
    }

    fn pull(&mut self, place: usize, to: Vec<f64>, strength: f64) -> Result<Value, String> {
        let node = self.picture.node(place).ok_or_else(|| format!("no node {place} is drawn"))?;
        let hand = Hand::new(self.simulation.scene(), [place, node], to, strength);
        let mut hand = hand.map_err(|error| error.to_string())?;
        if self.hand.as_ref().is_some_and(|held| !hand.takes_over(held)) {
            self.let_go().map_err(|error| error.to_string())?;
        }
        self.hand = Some(hand);
        Ok(json!({ "done": true }))
    }

    fn let_go(&mut self) -> Result<(), Error> {
        let goes_on = self.simulation.check_goes_on().is_ok();
        let held = self.hand.take().filter(|_| goes_on);
        held.map_or(Ok(()), |hand| hand.let_go(&mut self.simulation))
    }

    /// Advances by one portion of time.
    fn advance(&mut self) {
        let (from, end) = (self.simulation.time(), self.simulation.scene().end());
        let to = (from + self.pace.portion()).min(end);
        let result = self.go_to(to);
        self.pace.note(self.simulation.time() - from);
        match result {
            Err(error) => self.stop(&error),
            Ok(()) => self.playing = self.simulation.time() < end,
        }
    }

    /// Advances to `to` (s), or until it takes too long, with the hand where it is.
    fn go_to(&mut self, to: f64) -> Result<(), Error> {
        while self.simulation.time() < to {
            let mut next = to;
            if let Some(hand) = &mut self.hand {
                next = next.min(self.simulation.time() + hand.period);
                hand.pull(&mut self.simulation)?;
            }
            if !self.pass(next)? {
                break;
            }
        }
        Ok(())
    }

    /// Advances to `to` (s) under the present forces, and records the past. Returns whether there is time for
    /// more.
    fn pass(&mut self, to: f64) -> Result<bool, Error> {
        let fine = LONGEST.min(FINE * self.simulation.scene().end());
        let mut goes_on = true;
        while goes_on && self.simulation.time() < to {
            let from = self.simulation.time();
            let result = self.simulation.advance_to(to.min(from + fine));
            let is_later = self.simulation.time() > from;
            if is_later {
                self.past.note(&mut self.simulation);
            }
            result?;
            goes_on = is_later && !self.pace.is_spent();
        }
        Ok(goes_on)
    }

    /// Stops time, for a reason that is shown; the state stays as it is.
    fn stop(&mut self, error: &Error) {
        self.playing = false;
        self.trouble = Some(error.to_string());
    }
}

/// The answer to a message that failed.
pub(super) fn error_answer(error: &str) -> Value {
    json!({ "error": error })
}
