//! Kinds behind one type, so that a scenario can hold whichever its file names.

use std::any::{Any, TypeId};
use std::fmt::Debug;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator};

use super::{Broadcasts, Expected, InPieces, Kind, Problem, Sections, Shared, Start, Swarm, Targets};
use crate::metrics::{NotedFigure, TrialRecord};
use crate::protocol::detector::DetectorConfig;
use crate::protocol::{CompletionConfig, Layout, Protocol};
use crate::simulation::RunError;

/// A config of some [`Kind`]: the same methods, and what is known of its robots.
#[allow(missing_docs, clippy::missing_errors_doc)] // Each is documented at the kind's.
pub trait AnyKind: Any + Debug + Send + Sync + erased_serde::Serialize {
    fn name(&self) -> &'static str;
    fn is_unit(&self) -> bool;
    fn equals(&self, other: &dyn AnyKind) -> bool;
    /// Names of the roles.
    fn roles(&self) -> &'static [&'static str];
    /// Names of all topics, those of detectors that send among them.
    fn all_topics(&self) -> &'static [&'static str];
    /// Whether robots send statuses.
    fn has_statuses(&self) -> bool;
    /// Whether robots' messages can carry what a failure detector says.
    fn has_probes(&self) -> bool;
    /// Whether robots ask what is near.
    fn senses(&self) -> bool;
    fn topics(&self, detector: &DetectorConfig) -> &'static [&'static str];
    fn run(&self, swarm: &Swarm<'_>, start: Start<'_>) -> Result<TrialRecord, RunError>;
    fn mission(&self) -> Option<&'static str>;
    fn completion(&self) -> Option<CompletionConfig>;
    fn completed_by(&self, completion: CompletionConfig) -> Option<Arc<dyn AnyKind>>;
    fn heeds(&self, sections: &Sections<'_>) -> &'static [Shared];
    fn unheeded(&self, setting: Shared) -> &'static str;
    fn moves(&self, sections: &Sections<'_>) -> bool;
    fn problems(&self, sections: &Sections<'_>) -> Vec<(String, String)>;
    fn conflicts(&self, sections: &Sections<'_>) -> Vec<Problem>;
    fn warnings(&self, sections: &Sections<'_>, completion: CompletionConfig) -> Vec<Problem>;
    fn targets(&self) -> Option<Targets>;
    fn reserved(&self) -> Option<(u32, &'static str)>;
    fn in_pieces(&self, sections: &Sections<'_>) -> Option<InPieces>;
    fn frames_a_second(&self, sections: &Sections<'_>) -> f64;
    fn wakes_within(&self, sections: &Sections<'_>) -> Option<f64>;
    fn relays_in_steps(&self) -> bool;
    fn status_bytes(&self) -> Option<f64>;
    fn sends_statuses_alone(&self, sections: &Sections<'_>) -> bool;
    fn broadcasts(&self, sections: &Sections<'_>) -> Option<Broadcasts>;
    fn predict(&self, sections: &Sections<'_>) -> Expected;
    fn figures(&self) -> Vec<NotedFigure>;
}

erased_serde::serialize_trait_object!(AnyKind);

impl<K: Kind> AnyKind for K {
    fn name(&self) -> &'static str {
        K::NAME
    }

    fn is_unit(&self) -> bool {
        is_unit::<K>()
    }

    fn equals(&self, other: &dyn AnyKind) -> bool {
        let other: &dyn Any = other;
        other.downcast_ref::<K>() == Some(self)
    }

    fn roles(&self) -> &'static [&'static str] {
        K::Robot::ROLES
    }

    fn all_topics(&self) -> &'static [&'static str] {
        K::Robot::TOPICS
    }

    fn has_statuses(&self) -> bool {
        K::Robot::STATUS.is_some()
    }

    fn has_probes(&self) -> bool {
        K::Robot::PROBE.is_some()
    }

    fn senses(&self) -> bool {
        K::Robot::SENSES_PROXIMITY
    }

    fn topics(&self, detector: &DetectorConfig) -> &'static [&'static str] {
        Kind::topics(self, detector)
    }

    fn run(&self, swarm: &Swarm<'_>, start: Start<'_>) -> Result<TrialRecord, RunError> {
        Kind::run(self, swarm, start)
    }

    fn mission(&self) -> Option<&'static str> {
        Kind::mission(self)
    }

    fn completion(&self) -> Option<CompletionConfig> {
        Kind::completion(self)
    }

    fn completed_by(&self, completion: CompletionConfig) -> Option<Arc<dyn AnyKind>> {
        Kind::completed_by(self, completion).map(|config| Arc::new(config) as Arc<dyn AnyKind>)
    }

    fn heeds(&self, sections: &Sections<'_>) -> &'static [Shared] {
        Kind::heeds(self, sections)
    }

    fn unheeded(&self, setting: Shared) -> &'static str {
        Kind::unheeded(self, setting)
    }

    fn moves(&self, sections: &Sections<'_>) -> bool {
        Kind::moves(self, sections)
    }

    fn problems(&self, sections: &Sections<'_>) -> Vec<(String, String)> {
        Kind::problems(self, sections)
    }

    fn conflicts(&self, sections: &Sections<'_>) -> Vec<Problem> {
        Kind::conflicts(self, sections)
    }

    fn warnings(&self, sections: &Sections<'_>, completion: CompletionConfig) -> Vec<Problem> {
        Kind::warnings(self, sections, completion)
    }

    fn targets(&self) -> Option<Targets> {
        Kind::targets(self)
    }

    fn reserved(&self) -> Option<(u32, &'static str)> {
        Kind::reserved(self)
    }

    fn in_pieces(&self, sections: &Sections<'_>) -> Option<InPieces> {
        Kind::in_pieces(self, sections)
    }

    fn frames_a_second(&self, sections: &Sections<'_>) -> f64 {
        Kind::frames_a_second(self, sections)
    }

    fn wakes_within(&self, sections: &Sections<'_>) -> Option<f64> {
        Kind::wakes_within(self, sections)
    }

    fn relays_in_steps(&self) -> bool {
        Kind::relays_in_steps(self)
    }

    fn status_bytes(&self) -> Option<f64> {
        Kind::status_bytes(self)
    }

    fn sends_statuses_alone(&self, sections: &Sections<'_>) -> bool {
        Kind::sends_statuses_alone(self, sections)
    }

    fn broadcasts(&self, sections: &Sections<'_>) -> Option<Broadcasts> {
        Kind::broadcasts(self, sections)
    }

    fn predict(&self, sections: &Sections<'_>) -> Expected {
        Kind::predict(self, sections)
    }

    fn figures(&self) -> Vec<NotedFigure> {
        Kind::figures(self)
    }
}

/// What a config is read from where it stands in a scenario file, on the way noting its path.
pub type RonReader<'a, 'b, 'c, 'de> = serde_path_to_error::Deserializer<'a, 'b, &'c mut ron::Deserializer<'de>>;

/// Reads a config, from any format.
pub type ReadConfig = fn(&mut dyn erased_serde::Deserializer<'_>) -> Result<Arc<dyn AnyKind>, erased_serde::Error>;

/// A kind as the registry has it: what is known without a config.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// What scenarios call it.
    pub name: &'static str,
    /// The config's type.
    pub type_id: TypeId,
    /// Whether the config is a unit struct, which is named without brackets.
    pub is_unit: bool,
    /// Reads a config, from any format.
    pub read: ReadConfig,
    /// Reads a config from RON for the sake of the error, which any other way loses what it was of.
    pub read_ron: fn(RonReader<'_, '_, '_, '_>) -> Result<(), ron::Error>,
    /// How its messages lie in their bytes, if that is described.
    pub layout: fn() -> Layout,
    /// The schema of the config, or a reference to it.
    pub schema: fn(&mut SchemaGenerator) -> Schema,
    /// The schema itself.
    pub schema_in_place: fn(&mut SchemaGenerator) -> Schema,
}

impl Entry {
    /// That of `K`.
    #[must_use]
    pub fn of<K: Kind>() -> Self {
        Self {
            name: K::NAME,
            type_id: TypeId::of::<K>(),
            is_unit: is_unit::<K>(),
            read: |reader| erased_serde::deserialize::<K>(reader).map(|config| Arc::new(config) as Arc<dyn AnyKind>),
            read_ron: |reader| K::deserialize(reader).map(drop),
            layout: K::layout,
            schema: SchemaGenerator::subschema_for::<K>,
            schema_in_place: <K as JsonSchema>::json_schema,
        }
    }
}

/// Whether configs of a kind hold nothing.
fn is_unit<K: Kind>() -> bool {
    serde_json::from_value::<K>(serde_json::Value::Null).is_ok()
}
