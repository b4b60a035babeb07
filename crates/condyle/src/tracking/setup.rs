//! Requests from the setups of files.

#[cfg(feature = "document")]
use super::PostureRequest;
use super::Request;
#[cfg(any(feature = "document", feature = "opensim"))]
use super::{CoordinateRequest, CoordinateValue};
#[cfg(feature = "document")]
use condyle_formats::document::setup::TrackSetup;
#[cfg(feature = "opensim")]
use condyle_formats::opensim::setup::{self, IkSetup, IkTaskSet, IkTasks};

#[cfg(feature = "opensim")]
impl Request {
    /// What a setup of OpenSim's inverse kinematics asks for; files that it names are not opened.
    pub fn from_setup(setup: &IkSetup) -> Self {
        let mut request = Self {
            time_range: setup.time_range,
            closure_weight: setup.constraint_weight,
            ..Self::default()
        };
        if let IkTasks::Inline(tasks) = &setup.tasks {
            request.add_tasks(tasks);
        }
        request
    }

    /// What tasks alone ask for.
    pub fn from_tasks(tasks: &IkTaskSet) -> Self {
        let mut request = Self::default();
        request.add_tasks(tasks);
        request
    }

    fn add_tasks(&mut self, tasks: &IkTaskSet) {
        // A set without marker tasks asks for all markers, one whose tasks are off for none.
        if !tasks.markers.is_empty() {
            let on = tasks.markers.iter().filter(|t| t.apply);
            self.marker_weights = Some(on.map(|t| (t.name.clone(), t.weight)).collect());
        }
        let on = tasks.coordinates.iter().filter(|t| t.apply && t.weight > 0.0);
        let coordinate = |t: &setup::CoordinateTask| CoordinateRequest {
            name: t.name.clone(),
            weight: t.weight,
            value: match t.target {
                setup::CoordinateTarget::Default => CoordinateValue::Default,
                setup::CoordinateTarget::Manual(value) => CoordinateValue::Constant(value),
                setup::CoordinateTarget::FromFile => CoordinateValue::PerTime,
            },
        };
        self.coordinates = on.map(coordinate).collect();
    }
}

#[cfg(feature = "document")]
impl Request {
    /// What a setup that people write asks for; its table of names is not opened.
    pub fn from_document(setup: &TrackSetup) -> Self {
        let default = Self::default();
        let coordinates = setup.coordinates.iter().map(|task| CoordinateRequest {
            name: task.name.clone(),
            weight: task.weight,
            value: task.value.map_or(CoordinateValue::Default, CoordinateValue::Constant),
        });
        let postures = setup.postures.iter().map(|posture| PostureRequest {
            coordinates: posture.coordinates.clone(),
            rest: posture.rest,
            stiffness: posture.stiffness,
        });
        Self {
            weights: setup.weights.clone(),
            coordinates: coordinates.collect(),
            postures: postures.collect(),
            time_range: setup.time,
            limits: setup.limits.unwrap_or(default.limits),
            robust: setup.robust.unwrap_or(default.robust),
            max_rms: setup.max_rms.unwrap_or(default.max_rms),
            closure_weight: setup.loop_weight.unwrap_or(default.closure_weight),
            ..default
        }
    }
}
