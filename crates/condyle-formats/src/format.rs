//! The table of formats: by what names files go, what they hold, what is read and what is written.
//!
//! Who opens or writes a file asks this table; a new format is a folder, a row here, and its
//! documentation.

#[cfg(feature = "document")]
use crate::document::{
    self, Document, Kind, goals::GoalList, landmarks::LandmarksDocument, law::LawDocument,
    names::NameTable, setup::TrackSetup,
};
#[cfg(feature = "glb")]
use crate::glb;
#[cfg(feature = "opensim")]
use crate::opensim::{self, setup};
use crate::skeleton::Assumed;
#[cfg(feature = "smpl")]
use crate::smpl;
#[cfg(feature = "document")]
use crate::text::utf8;
#[cfg(feature = "urdf")]
use crate::urdf;
use crate::{Animation, Error, Read, Recording, Table, asf, bvh, c3d, csv, skel, sto, trc};
#[cfg(feature = "poses")]
use crate::{
    exchange, keypoints,
    poses::{self, Poses},
};
#[cfg(feature = "document")]
use condyle_learn::frames::Recipe;
#[cfg(feature = "document")]
use condyle_learn::limits::{LearnedLimit, herda2003::LearnedSpheres};
use condyle_model::Model;

/// What a file may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContentKind {
    /// A model.
    Model,
    /// A marker recording.
    Recording,
    /// A motion or another table over time.
    Motion,
    /// Poses by the names of coordinates.
    Poses,
    /// A setup of inverse kinematics, or its tasks.
    Setup,
    /// A table of names.
    Names,
    /// What a pose should do.
    Goals,
    /// Which markers give the orientation of a segment.
    Recipe,
    /// Which rotations of a segment in another are possible.
    Limit,
    /// How coordinates follow others.
    Law,
    /// Where a law is carried to.
    Landmarks,
    /// A scene for viewers.
    Scene,
}

impl ContentKind {
    /// Its name with an article, for messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Model => "a model",
            Self::Recording => "a marker recording",
            Self::Motion => "a motion",
            Self::Poses => "poses",
            Self::Setup => "a tracking setup",
            Self::Names => "a table of names",
            Self::Goals => "goals of a pose",
            Self::Recipe => "a recipe",
            Self::Limit => "a learned limit",
            Self::Law => "a law of coordinates",
            Self::Landmarks => "landmarks of joints",
            Self::Scene => "a scene",
        }
    }
}

/// What a file was found to hold.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Content {
    /// A model that never was text.
    Model(Model),
    /// A model with the text it was written as.
    #[cfg(feature = "document")]
    Document(Document),
    /// A marker recording.
    Recording(Recording),
    /// A marker recording with all that stands beside it.
    Trial(Box<c3d::Trial>),
    /// A table over time.
    Table(Table),
    /// A skeleton with what it does: a model and a motion at once.
    Animation(Box<Animation>),
    /// Poses by the names of coordinates.
    #[cfg(feature = "poses")]
    Poses(Poses),
    /// A setup that people write.
    #[cfg(feature = "document")]
    TrackSetup(TrackSetup),
    /// A table of names.
    #[cfg(feature = "document")]
    Names(NameTable),
    /// What a pose should do.
    #[cfg(feature = "document")]
    Goals(GoalList),
    /// Which markers give the orientation of a segment.
    #[cfg(feature = "document")]
    Recipe(Recipe),
    /// Which rotations of a segment in another are possible.
    #[cfg(feature = "document")]
    Limit(Box<LearnedLimit>),
    /// The same by the method of Herda et al. 2003.
    #[cfg(feature = "document")]
    Spheres(Box<LearnedSpheres>),
    /// How coordinates follow others.
    #[cfg(feature = "document")]
    Law(Box<LawDocument>),
    /// Where a law is carried to.
    #[cfg(feature = "document")]
    Landmarks(Box<LandmarksDocument>),
    /// A setup of inverse kinematics.
    #[cfg(feature = "opensim")]
    Setup(setup::IkSetup),
    /// The tasks of such a setup alone.
    #[cfg(feature = "opensim")]
    Tasks(setup::IkTaskSet),
}

impl Content {
    /// Whether it can be used as this: a skeleton with its motion as a model and as a motion.
    #[must_use]
    pub fn holds(&self, kind: ContentKind) -> bool {
        match self {
            Self::Animation(_) => matches!(kind, ContentKind::Model | ContentKind::Motion),
            other => other.kind() == kind,
        }
    }

    /// What it is; of a skeleton with its motion [`ContentKind::Motion`].
    #[must_use]
    pub fn kind(&self) -> ContentKind {
        match self {
            Self::Model(_) => ContentKind::Model,
            #[cfg(feature = "document")]
            Self::Document(_) => ContentKind::Model,
            Self::Recording(_) | Self::Trial(_) => ContentKind::Recording,
            Self::Table(_) | Self::Animation(_) => ContentKind::Motion,
            #[cfg(feature = "poses")]
            Self::Poses(_) => ContentKind::Poses,
            #[cfg(feature = "document")]
            Self::TrackSetup(_) => ContentKind::Setup,
            #[cfg(feature = "document")]
            Self::Names(_) => ContentKind::Names,
            #[cfg(feature = "document")]
            Self::Goals(_) => ContentKind::Goals,
            #[cfg(feature = "document")]
            Self::Recipe(_) => ContentKind::Recipe,
            #[cfg(feature = "document")]
            Self::Limit(_) | Self::Spheres(_) => ContentKind::Limit,
            #[cfg(feature = "document")]
            Self::Law(_) => ContentKind::Law,
            #[cfg(feature = "document")]
            Self::Landmarks(_) => ContentKind::Landmarks,
            #[cfg(feature = "opensim")]
            Self::Setup(_) | Self::Tasks(_) => ContentKind::Setup,
        }
    }
}

/// The formats, for code that treats one of them in a way of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Id {
    /// Documents in TOML.
    Document,
    /// OpenSim's models and setups.
    OpenSim,
    /// Robot descriptions.
    Urdf,
    /// Models of MuJoCo.
    Mjcf,
    /// Scenes of Universal Scene Description.
    Usda,
    /// Marker recordings.
    Trc,
    /// Marker recordings with analog channels and events.
    C3d,
    /// OpenSim's motions.
    Mot,
    /// OpenSim's storage files.
    Sto,
    /// Comma-separated tables.
    Csv,
    /// Poses and resolved models in JSON.
    Poses,
    /// 3D keypoints of pose estimators.
    Keypoints,
    /// Binary glTF.
    Glb,
    /// glTF in JSON, and the files of VRM, which are GLB.
    Gltf,
    /// Scenes of Autodesk's programs.
    Fbx,
    /// Skeletons with motion of Biovision.
    Bvh,
    /// Skeletons of the course CSE 169.
    Skel,
    /// Skeletons of Acclaim.
    Asf,
    /// Takes of Acclaim's skeletons.
    Amc,
    /// Poses and bodies of SMPL.
    Smpl,
}

/// The text of another file by its path as seen from the one that is read; else a sentence.
pub type Include<'i> = dyn FnMut(&str) -> Result<String, String> + 'i;

/// One format.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// Which it is.
    pub id: Id,
    /// Its name, which is its first ending.
    pub name: &'static str,
    /// What it is, for people.
    pub title: &'static str,
    /// The endings of its files, in lower case, without the dot.
    pub endings: &'static [&'static str],
    /// What is read from it.
    pub reads: &'static [ContentKind],
    /// What is written in it.
    pub writes: &'static [ContentKind],
    /// Whether bytes look like it.
    sniff: fn(&[u8]) -> bool,
    read: fn(&[u8], &mut Include<'_>) -> Result<Read<Content>, Error>,
}

/// All formats; of two that look alike the more particular one stands first.
pub const FORMATS: &[Format] = &[
    #[cfg(feature = "document")]
    Format {
        id: Id::Document,
        name: "toml",
        title: "documents that people write",
        endings: &["toml"],
        reads: &[
            ContentKind::Model,
            ContentKind::Setup,
            ContentKind::Names,
            ContentKind::Goals,
            ContentKind::Recipe,
            ContentKind::Limit,
            ContentKind::Law,
            ContentKind::Landmarks,
        ],
        writes: &[ContentKind::Model, ContentKind::Limit, ContentKind::Law],
        sniff: |bytes| document::kind(bytes).is_some(),
        read: |bytes, include| {
            let text = utf8(bytes)?;
            Ok(match document::kind(bytes) {
                Some(Kind::Setup) => document::setup::read(text, include)?.map(Content::TrackSetup),
                Some(Kind::Names) => document::names::read(text, include)?.map(Content::Names),
                Some(Kind::Goals) => document::goals::read(text, include)?.map(Content::Goals),
                Some(Kind::Recipe) => document::recipe::read(text, include)?.map(Content::Recipe),
                Some(Kind::Limit) if document::limit::is_of_spheres(text) => {
                    document::limit::read_spheres(text, include)?
                        .map(|spheres| Content::Spheres(Box::new(spheres)))
                }
                Some(Kind::Limit) => document::limit::read(text, include)?
                    .map(|limit| Content::Limit(Box::new(limit))),
                Some(Kind::Law) => {
                    document::law::read(text, include)?.map(|law| Content::Law(Box::new(law)))
                }
                Some(Kind::Landmarks) => document::landmarks::read(text, include)?
                    .map(|landmarks| Content::Landmarks(Box::new(landmarks))),
                // Those that are no document at all get the message of a model.
                _ => document::read(text, include)?.map(Content::Document),
            })
        },
    },
    #[cfg(feature = "opensim")]
    Format {
        id: Id::OpenSim,
        name: "osim",
        title: "OpenSim's models and setups",
        endings: &["osim", "xml"],
        reads: &[ContentKind::Model, ContentKind::Setup],
        writes: &[ContentKind::Model],
        sniff: |bytes| starts(bytes, 4096).contains("<OpenSimDocument"),
        read: |bytes, include| {
            Ok(opensim::read(bytes, include)?.map(|holding| match holding {
                opensim::Holding::Model(model) => Content::Model(model),
                opensim::Holding::Setup(setup) => Content::Setup(setup),
                opensim::Holding::Tasks(tasks) => Content::Tasks(tasks),
            }))
        },
    },
    #[cfg(feature = "mjcf")]
    Format {
        id: Id::Mjcf,
        name: "mjcf",
        title: "models of MuJoCo",
        endings: &["mjcf"],
        reads: &[],
        writes: &[ContentKind::Model],
        sniff: |bytes| starts(bytes, 4096).contains("<mujoco"),
        read: |_, _| Err(Error::new("mjcf/not-read", "models of MuJoCo are written, not read")),
    },
    #[cfg(feature = "usd")]
    Format {
        id: Id::Usda,
        name: "usda",
        title: "UsdSkel scenes",
        endings: &["usda"],
        reads: &[],
        writes: &[ContentKind::Scene],
        sniff: |bytes| bytes.starts_with(b"#usda"),
        read: |_, _| Err(Error::new("usd/not-read", "scenes are written, not read")),
    },
    Format {
        id: Id::Trc,
        name: "trc",
        title: "marker recordings of Motion Analysis",
        endings: &["trc"],
        reads: &[ContentKind::Recording],
        writes: &[ContentKind::Recording],
        sniff: |bytes| starts(bytes, 64).to_ascii_lowercase().starts_with("pathfiletype"),
        read: |bytes, _| trc::from_bytes(bytes).map(|read| read.map(Content::Recording)),
    },
    Format {
        id: Id::C3d,
        name: "c3d",
        title: "recordings of markers, analog channels and events",
        endings: &["c3d"],
        reads: &[ContentKind::Recording],
        writes: &[ContentKind::Recording],
        sniff: c3d::is_c3d,
        read: |bytes, _| {
            c3d::from_bytes(bytes).map(|read| read.map(|trial| Content::Trial(Box::new(trial))))
        },
    },
    Format {
        id: Id::Mot,
        name: "mot",
        title: "OpenSim's motions, in degrees",
        endings: &["mot"],
        reads: &[ContentKind::Motion],
        writes: &[ContentKind::Motion],
        sniff: |bytes| starts(bytes, 1 << 16).lines().any(|line| line.trim() == "endheader"),
        read: |bytes, _| sto::from_bytes(bytes).map(|read| read.map(Content::Table)),
    },
    Format {
        id: Id::Sto,
        name: "sto",
        title: "OpenSim's storage files, in degrees",
        endings: &["sto"],
        reads: &[ContentKind::Motion],
        writes: &[ContentKind::Motion],
        sniff: |_| false,
        read: |bytes, _| sto::from_bytes(bytes).map(|read| read.map(Content::Table)),
    },
    #[cfg(feature = "poses")]
    Format {
        id: Id::Keypoints,
        name: "jsonl",
        title: "3D keypoints of pose estimators, a frame a line; also as .json and .csv",
        endings: &["jsonl", "ndjson"],
        reads: &[ContentKind::Recording],
        writes: &[],
        sniff: |bytes| match starts(bytes, 64).starts_with(['{', '[']) {
            true => !exchange::is_model(bytes) && keypoints::is_json(bytes),
            false => keypoints::is_table(bytes),
        },
        read: |bytes, _| keypoints::from_bytes(bytes).map(|read| read.map(Content::Recording)),
    },
    #[cfg(feature = "urdf")]
    Format {
        id: Id::Urdf,
        name: "urdf",
        title: "robot descriptions of ROS",
        endings: &["urdf"],
        reads: &[ContentKind::Model],
        writes: &[ContentKind::Model],
        sniff: |bytes| starts(bytes, 4096).contains("<robot"),
        read: |bytes, _| urdf::from_bytes(bytes).map(|read| read.map(Content::Model)),
    },
    Format {
        id: Id::Csv,
        name: "csv",
        title: "comma-separated tables, in radians and metres where a model says which is which",
        endings: &["csv"],
        reads: &[ContentKind::Motion, ContentKind::Recording],
        writes: &[ContentKind::Motion, ContentKind::Recording],
        sniff: |bytes| {
            let start = starts(bytes, 4096).to_ascii_lowercase();
            let names = start.lines().find(|line| !line.starts_with('#'));
            start.starts_with("# indegrees=") || names.is_some_and(|line| line.starts_with("time,"))
        },
        read: |bytes, _| csv::from_bytes(bytes).map(|read| read.map(Content::Table)),
    },
    #[cfg(feature = "fbx")]
    Format {
        id: Id::Fbx,
        name: "fbx",
        title: "FBX: skeletons and animations",
        endings: &["fbx"],
        reads: &[ContentKind::Motion, ContentKind::Model],
        writes: &[],
        sniff: |bytes| {
            bytes.starts_with(b"Kaydara FBX Binary") || starts(bytes, 64).starts_with("; FBX ")
        },
        read: |bytes, _| animation(crate::fbx::from_bytes(bytes)),
    },
    #[cfg(feature = "glb")]
    Format {
        id: Id::Glb,
        name: "glb",
        title: "binary glTF: skins, their skeletons and animations; animated scenes",
        endings: &["glb"],
        reads: &[ContentKind::Motion, ContentKind::Model],
        writes: &[ContentKind::Scene],
        sniff: |bytes| bytes.starts_with(b"glTF"),
        read: |bytes, _| animation(glb::from_bytes(bytes)),
    },
    #[cfg(feature = "glb")]
    Format {
        id: Id::Gltf,
        name: "gltf",
        title: "glTF in JSON, and VRM: skins, their skeletons and animations",
        endings: &["gltf", "vrm"],
        reads: &[ContentKind::Motion, ContentKind::Model],
        writes: &[],
        sniff: glb::looks_like_json,
        read: |bytes, _| animation(glb::from_bytes(bytes)),
    },
    #[cfg(feature = "poses")]
    Format {
        id: Id::Poses,
        name: "json",
        title: "poses by the names of coordinates, resolved models, and 3D keypoints",
        endings: &["json"],
        reads: &[ContentKind::Poses, ContentKind::Model, ContentKind::Recording],
        writes: &[ContentKind::Model],
        sniff: |bytes| starts(bytes, 1024).starts_with(['{', '[']),
        read: |bytes, _| match exchange::is_model(bytes) {
            true => exchange::read(bytes).map(|read| read.map(Content::Model)),
            false => poses::read(bytes).map(|read| read.map(Content::Poses)),
        },
    },
    Format {
        id: Id::Skel,
        name: "skel",
        title: "skeletons of the course CSE 169",
        endings: &["skel"],
        reads: &[ContentKind::Model],
        writes: &[],
        sniff: |bytes| keyword(bytes).starts_with("balljoint"),
        read: |bytes, _| Ok(skel::read(bytes, &Assumed::default())?.map(Content::Model)),
    },
    Format {
        id: Id::Asf,
        name: "asf",
        title: "skeletons of Acclaim",
        endings: &["asf"],
        reads: &[ContentKind::Model],
        writes: &[],
        sniff: |bytes| keyword(bytes).starts_with(":version"),
        read: |bytes, _| Ok(asf::read(bytes, &Assumed::default())?.map(Content::Model)),
    },
    Format {
        id: Id::Amc,
        name: "amc",
        title: "takes of Acclaim's skeletons",
        endings: &["amc"],
        reads: &[ContentKind::Motion, ContentKind::Model],
        writes: &[ContentKind::Scene],
        sniff: |bytes| keyword(bytes).starts_with(":fully-specified"),
        read: |_, _| {
            let message = "a take means nothing without its skeleton, an .asf file";
            Err(Error::new("amc/skeleton", message).with_help("read it with its skeleton"))
        },
    },
    #[cfg(feature = "smpl")]
    Format {
        id: Id::Smpl,
        name: "npz",
        title: "poses of SMPL, SMPL-H and SMPL-X, and their bodies",
        endings: &["npz"],
        reads: &[ContentKind::Motion, ContentKind::Model],
        writes: &[],
        sniff: smpl::is_npz,
        read: |bytes, _| {
            if smpl::is_body(bytes) {
                let Read { value: rest, warnings } = smpl::rest(bytes)?;
                let mut read = rest.model()?;
                read.warnings.extend(warnings);
                return Ok(read.map(Content::Model));
            }
            let message = "poses of SMPL mean nothing without the places of joints, a body";
            Err(Error::new("smpl/rest", message).with_help("read them with a body"))
        },
    },
    Format {
        id: Id::Bvh,
        name: "bvh",
        title: "skeletons with motion of Biovision",
        endings: &["bvh"],
        reads: &[ContentKind::Motion, ContentKind::Model],
        writes: &[ContentKind::Scene],
        sniff: |bytes| starts(bytes, 64).to_ascii_lowercase().starts_with("hierarchy"),
        read: |bytes, _| animation(bvh::from_bytes(bytes)),
    },
];

fn animation(read: Result<Read<Animation>, Error>) -> Result<Read<Content>, Error> {
    read.map(|read| read.map(|animation| Content::Animation(Box::new(animation))))
}

/// The first line that is no comment, in lower case.
fn keyword(bytes: &[u8]) -> String {
    let text = starts(bytes, 4096).to_ascii_lowercase();
    let line = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'));
    line.unwrap_or("").to_owned()
}

/// The beginning of a file as text, without a byte order mark.
fn starts(bytes: &[u8], most: usize) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(most)]);
    text.trim_start_matches('\u{feff}').trim_start().to_owned()
}

impl Format {
    /// The format of this ending, in any case.
    ///
    /// ```
    /// use condyle_formats::{Format, ContentKind};
    /// assert_eq!(Format::of_ending("TRC").map(|f| f.reads), Some(&[ContentKind::Recording][..]));
    /// assert!(Format::of_ending("doc").is_none());
    /// ```
    #[must_use]
    pub fn of_ending(ending: &str) -> Option<&'static Self> {
        FORMATS.iter().find(|f| f.endings.iter().any(|known| known.eq_ignore_ascii_case(ending)))
    }

    /// The format that bytes look like.
    ///
    /// ```
    /// use condyle_formats::{Format, Id};
    /// let found = Format::of_bytes(b"PathFileType\t4\t(X/Y/Z)\ta.trc\n");
    /// assert_eq!(found.map(|f| f.id), Some(Id::Trc));
    /// assert!(Format::of_bytes(b"Dear Sir").is_none());
    /// ```
    #[must_use]
    pub fn of_bytes(bytes: &[u8]) -> Option<&'static Self> {
        FORMATS.iter().find(|f| (f.sniff)(bytes))
    }

    /// Reads whatever bytes of this format hold.
    ///
    /// # Errors
    /// What is wrong, with its place.
    pub fn read(&self, bytes: &[u8], include: &mut Include<'_>) -> Result<Read<Content>, Error> {
        #[cfg(feature = "poses")]
        if matches!(self.id, Id::Csv | Id::Poses) && self.holds_keypoints(bytes) {
            return keypoints::from_bytes(bytes).map(|read| read.map(Content::Recording));
        }
        (self.read)(bytes, include)
    }

    /// As [`Format::read`], with what is known of a skeleton whose file does not state it.
    ///
    /// # Errors
    /// What is wrong, with its place.
    pub fn read_with(
        &self,
        bytes: &[u8],
        include: &mut Include<'_>,
        assumed: &Assumed,
    ) -> Result<Read<Content>, Error> {
        match self.id {
            Id::Bvh => animation(bvh::from_bytes_with(bytes, assumed)),
            Id::Skel => Ok(skel::read(bytes, assumed)?.map(Content::Model)),
            #[cfg(feature = "fbx")]
            Id::Fbx => {
                let options = glb::Options { assumed: *assumed, ..glb::Options::default() };
                animation(crate::fbx::read(bytes, &options))
            }
            Id::Asf => Ok(asf::read(bytes, assumed)?.map(Content::Model)),
            #[cfg(feature = "glb")]
            Id::Glb | Id::Gltf => {
                let options = glb::Options { assumed: *assumed, ..glb::Options::default() };
                animation(glb::read(bytes, &options, &mut |_| Err("the file is read alone".into())))
            }
            #[cfg(feature = "poses")]
            Id::Keypoints | Id::Csv | Id::Poses if self.holds_keypoints(bytes) => {
                keypoints::from_bytes_with(bytes, assumed).map(|read| read.map(Content::Recording))
            }
            _ => self.read(bytes, include),
        }
    }

    /// Whether bytes of a format that can hold keypoints do.
    #[cfg(feature = "poses")]
    fn holds_keypoints(&self, bytes: &[u8]) -> bool {
        match self.id {
            Id::Keypoints => true,
            Id::Csv => keypoints::is_table(bytes),
            _ => !exchange::is_model(bytes) && keypoints::is_json(bytes),
        }
    }

    /// The endings of all formats that hold this: `.mot, .sto, .csv`.
    #[must_use]
    pub fn endings_that_read(kind: ContentKind) -> String {
        endings(|f| f.reads.contains(&kind))
    }

    /// The endings of all formats in which this is written.
    #[must_use]
    pub fn endings_that_write(kind: ContentKind) -> String {
        endings(|f| f.writes.contains(&kind))
    }
}

fn endings(chosen: impl Fn(&Format) -> bool) -> String {
    let chosen = FORMATS.iter().filter(|f| chosen(f)).flat_map(|f| f.endings);
    chosen.map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_first_endings_and_no_ending_is_claimed_twice() {
        let mut seen = std::collections::HashSet::new();
        for format in FORMATS {
            assert_eq!(format.name, format.endings[0]);
            assert!(format.endings.iter().all(|ending| seen.insert(ending)), "{format:?}");
        }
    }

    #[test]
    fn what_is_written_is_recognised_and_read_as_that() {
        let recording = Recording {
            labels: vec!["RASI".into()],
            rate: 100.0,
            times: vec![0.0],
            positions: vec![[0.1, 0.9, 0.0].into()],
            ..Recording::default()
        };
        let table = recording.to_table();
        let samples = [
            (Id::Trc, trc::write(&recording, "a.trc").unwrap()),
            (Id::Mot, sto::write(&table).unwrap()),
            (Id::Csv, csv::write(&table).unwrap()),
            (Id::Poses, "{\"flexion\": 0.5}".to_owned()),
            (
                Id::Gltf,
                "{\"nodes\": [{}], \"skins\": [{\"joints\": [0]}], \"asset\": {\"version\": \"2.0\"}}".into(),
            ),
            (
                Id::Bvh,
                "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\n1\n".into(),
            ),
            (Id::Document, "# x\ncondyle = 1\nkind = \"model\"\n[segment.a]\n".to_owned()),
            (Id::Urdf, "<robot name=\"r\"><link name=\"a\"/></robot>".to_owned()),
            (
                Id::OpenSim,
                "<?xml version=\"1.0\"?>\n<OpenSimDocument><Model/></OpenSimDocument>".into(),
            ),
        ];
        for (id, text) in samples {
            let format = Format::of_bytes(text.as_bytes()).unwrap();
            assert_eq!(format.id, id, "{text}");
            let read = format.read(text.as_bytes(), &mut |_| Err("alone".into()));
            let read = read.unwrap_or_else(|error| panic!("{id:?}: {error}"));
            assert!(format.reads.contains(&read.value.kind()), "{id:?}");
        }
    }
}
