//! The node's publishers, subscriptions and services.

use crate::settings::{Ros2, Ros2Objects};
use crate::types::{
    AlvarMarkers, Detection3DArray, DiagnosticArray, Empty, JointState, MarkerArray, Text,
    TfMessage,
};
use opening::{Opening, latched, reliable};
use ros2_client::Node;
use rustdds::mio1::{Events, Poll};
use std::os::fd::{AsRawFd, BorrowedFd};
use std::time::Duration;

pub(crate) mod opening;
mod ports;

pub(crate) use ports::{Call, Inlet, Outlet, Trigger};

/// The node cannot be opened.
pub(crate) type Error = String;

/// Everything that the node publishes, hears and serves.
pub(crate) struct Dds {
    pub(crate) joint_states: Outlet<JointState>,
    pub(crate) robot_description: Outlet<Text>,
    pub(crate) say: Outlet<Text>,
    pub(crate) heard: Outlet<Text>,
    pub(crate) objects: Outlet<MarkerArray>,
    pub(crate) tf: Outlet<TfMessage>,
    pub(crate) state: Outlet<Text>,
    pub(crate) diagnostics: Outlet<DiagnosticArray>,
    pub(crate) hear: Inlet<Text>,
    pub(crate) stop_topic: Inlet<Empty>,
    pub(crate) detections: Option<Inlet<Detection3DArray>>,
    pub(crate) ar_markers: Option<Inlet<AlvarMarkers>>,
    pub(crate) marker_frames: Option<Inlet<TfMessage>>,
    pub(crate) stop: Trigger,
    pub(crate) resume: Trigger,
    pub(crate) cancel: Trigger,
    pub(crate) arrivals: Arrivals,
    _node: Node,
}

/// What wakes a node: something has arrived.
pub(crate) struct Arrivals {
    poll: Poll,
    events: Events,
}

impl Dds {
    /// Joins the domain.
    pub(crate) fn open(settings: &Ros2) -> Result<Self, Error> {
        let mut opening = Opening::join(settings, &settings.node)?;
        let o = &mut opening;
        let text = ("std_msgs", "String");
        let namespace = settings.namespace.as_str();
        let joints = ("sensor_msgs", "JointState");
        let markers = ("visualization_msgs", "MarkerArray");
        let diagnostics = ("diagnostic_msgs", "DiagnosticArray");
        let empty = ("std_msgs", "Empty");
        let transforms = ("tf2_msgs", "TFMessage");
        let detections = ("vision_msgs", "Detection3DArray");
        let ar_markers = ("ar_track_alvar_msgs", "AlvarMarkers");
        let Ros2Objects { detections: seen, ar_markers: alvar, tf, .. } = &settings.objects;
        // What stops the robot is there first.
        let (stop_topic, stop) = (o.own_inlet("stop", empty)?, o.trigger("stop")?);
        let (resume, cancel) = (o.trigger("resume")?, o.trigger("cancel")?);
        Ok(Self {
            stop_topic,
            stop,
            resume,
            cancel,
            hear: o.own_inlet("hear", text)?,
            detections: o.detector(seen.as_ref(), detections, 4)?,
            ar_markers: o.detector(alvar.as_ref(), ar_markers, 4)?,
            marker_frames: o.detector(tf.as_ref(), transforms, 100)?,
            joint_states: o.outlet((namespace, "joint_states"), joints, &reliable(10))?,
            robot_description: o.outlet((namespace, "robot_description"), text, &latched())?,
            say: o.own_outlet("say", text, &reliable(10))?,
            heard: o.own_outlet("heard", text, &reliable(10))?,
            objects: o.own_outlet("objects", markers, &latched())?,
            tf: o.outlet(("/", "tf"), transforms, &reliable(100))?,
            state: o.own_outlet("state", text, &latched())?,
            diagnostics: o.outlet(("/", "diagnostics"), diagnostics, &reliable(10))?,
            arrivals: Arrivals::new(opening.poll),
            _node: opening.node,
        })
    }
}

impl Arrivals {
    /// Returns the arrivals of everything that is registered there.
    pub(crate) fn new(poll: Poll) -> Self {
        Self { poll, events: Events::with_capacity(32) }
    }

    /// Readable while something may wait to be taken.
    pub(crate) fn fd(&self) -> BorrowedFd<'_> {
        // SAFETY: the descriptor belongs to `self.poll`, which the result borrows.
        #[allow(unsafe_code)]
        unsafe {
            BorrowedFd::borrow_raw(self.poll.as_raw_fd())
        }
    }

    /// Resets the descriptor; to be called before anything is taken, so that nothing is missed.
    pub(crate) fn clear(&mut self) {
        // Interrupted or not: everything is taken.
        let _ = self.poll.poll(&mut self.events, Some(Duration::ZERO));
    }
}
