//! The socket of one live viewer.

use std::sync::Arc;

use axum::extract::ws::{Message as Frame, WebSocket, close_code};
use futures_util::StreamExt;
use futures_util::stream::SplitStream;
use recording::live::{self as protocol, Call, Level, Request};
use service::clock;
use service::console_link::random_secret;
use tokio::sync::{Notify, mpsc};
use tokio::time::{Instant, interval_at};
use web_server::connections::Connection;

use super::say;
use crate::hub::command::Verb;
use crate::hub::outbound::Answer;
use crate::hub::{OutboundFrame, Role, ViewerId};
use crate::server::App;
use crate::server::socket::{Ended, Out, PROBE_EVERY, Pace, close, send};

/// Answers that wait for a viewer; one that does not take them is not read meanwhile.
const REPLIES_MAX: usize = 16;
/// Shortest time between two reports of losses.
const REPORT_EVERY: std::time::Duration = std::time::Duration::from_secs(1);

/// Serves one viewer until it goes, does not read, or the console ends.
pub async fn serve(socket: WebSocket, connection: Arc<Connection>, app: Arc<App>, role: Role) {
    let (mut out, into) = socket.split();
    let joined = random_secret()
        .map_err(|error| error.to_string())
        .and_then(|session| app.hub.join("Foxglove", &session, role, clock::now()));
    let (viewer, outbound) = match joined {
        Ok(joined) => joined,
        Err(why) => return close(&mut out, close_code::AGAIN, &why).await,
    };
    connection.become_page();
    let arrived = app.live.viewers.join(viewer);
    app.hub.metrics.live_viewers.inc();
    tracing::info!(%viewer, ?role, "a live viewer has connected");
    let (replies, replied) = mpsc::channel(REPLIES_MAX);
    let reader = Reader { viewer, role, app: &app, replies };
    let mut writer = Writer { out: &mut out, viewer, app: &app };
    let ended = tokio::select! {
        ended = writer.run(outbound, replied, &arrived) => ended,
        ended = reader.run(into) => ended,
    };
    app.live.viewers.leave(viewer);
    app.hub.metrics.live_viewers.dec();
    app.hub.leave(viewer, clock::now());
    tracing::info!(%viewer, "a live viewer has disconnected: {ended:?}");
    if matches!(ended, Ended::Slow) {
        app.hub.metrics.dropped.inc();
    }
    let (code, reason) = ended.close_frame();
    close(&mut out, code, reason).await;
}

struct Writer<'a> {
    out: &'a mut Out,
    viewer: ViewerId,
    app: &'a App,
}

impl Writer<'_> {
    async fn run(
        &mut self,
        mut outbound: mpsc::Receiver<OutboundFrame>,
        mut replied: mpsc::Receiver<Frame>,
        arrived: &Notify,
    ) -> Ended {
        let app = self.app;
        let mut ending = app.hub.ending();
        let mut probe = interval_at(Instant::now() + PROBE_EVERY, PROBE_EVERY);
        let mut reported = Instant::now();
        for text in &app.live.greeting {
            if let Err(ended) = self.send(Frame::Text(text.into())).await {
                return ended;
            }
        }
        loop {
            // Answers come before messages of channels, of which there may always be another one.
            let frame = tokio::select! {
                biased;
                _ = ending.wait_for(|ending| *ending) => return Ended::Console,
                frame = outbound.recv() => match frame {
                    Some(OutboundFrame::Answer(id, outcome)) => answered(id, &outcome),
                    Some(OutboundFrame::Replaced) => return Ended::Replaced,
                    Some(OutboundFrame::GaveWay) => return Ended::GaveWay,
                    // Messages of the page's own protocol.
                    Some(OutboundFrame::Text(_)) => continue,
                    None => return Ended::Slow,
                },
                Some(reply) = replied.recv() => reply,
                _ = probe.tick() => Frame::Ping(Vec::new().into()),
                frame = self.next(arrived) => frame,
            };
            if let Err(ended) = self.send(frame).await {
                return ended;
            }
            if reported.elapsed() >= REPORT_EVERY {
                reported = Instant::now();
                if let Some(report) = self.losses()
                    && let Err(ended) = self.send(report).await
                {
                    return ended;
                }
            }
        }
    }

    /// Waits for the next message of a channel.
    async fn next(&self, arrived: &Notify) -> Frame {
        loop {
            if let Some(due) = self.app.live.viewers.next(self.viewer) {
                let (at_ns, data) = (due.message.at_ns, &due.message.data);
                return Frame::Binary(protocol::message_data(due.subscription, at_ns, data).into());
            }
            arrived.notified().await;
        }
    }

    fn losses(&self) -> Option<Frame> {
        let lost = self.app.live.viewers.take_lost(self.viewer);
        let report = || {
            let what = format!("{lost} messages were dropped: this viewer reads too slowly");
            Frame::Text(protocol::status(Level::Warning, &what).into())
        };
        (lost > 0).then(report)
    }

    async fn send(&mut self, frame: Frame) -> Result<(), Ended> {
        send(self.out, frame, &self.app.hub).await
    }
}

/// Renders the outcome of a call.
fn answered(id: u64, outcome: &Result<Option<Answer>, String>) -> Frame {
    // The number of a call has 32 bits.
    let call = u32::try_from(id).unwrap_or_default();
    match outcome {
        Ok(Some(Answer::Accepted { seq, known, .. })) => {
            let response = serde_json::json!({ "utterance": seq, "known": known });
            Frame::Binary(protocol::call_response(say::NUMBER, call, &response).into())
        }
        Ok(_) => Frame::Text(protocol::call_failure(say::NUMBER, call, "no utterance").into()),
        Err(why) => Frame::Text(protocol::call_failure(say::NUMBER, call, why).into()),
    }
}

struct Reader<'a> {
    viewer: ViewerId,
    role: Role,
    app: &'a App,
    replies: mpsc::Sender<Frame>,
}

impl Reader<'_> {
    async fn run(&self, mut into: SplitStream<WebSocket>) -> Ended {
        let mut pace = Pace::default();
        loop {
            let request = match pace.next(&mut into).await {
                Ok(Frame::Text(text)) => protocol::read_text(&text),
                Ok(Frame::Binary(bytes)) => protocol::read_binary(&bytes),
                Ok(_) => continue,
                Err(ended) => return ended,
            };
            self.app.hub.note(self.viewer, clock::now());
            let replies = match request {
                Ok(request) => self.carry_out(request),
                Err(why) => vec![protocol::status(Level::Error, &why)],
            };
            for reply in replies {
                if self.replies.send(Frame::Text(reply.into())).await.is_err() {
                    return Ended::Page;
                }
            }
        }
    }

    /// Carries out a request; returns the answers to it.
    fn carry_out(&self, request: Request) -> Vec<String> {
        let (live, viewer) = (&self.app.live, self.viewer);
        let error = |why: String| protocol::status(Level::Error, &why);
        match request {
            Request::Subscribe(wanted) => {
                let subscribe = |wanted| live.viewers.subscribe(viewer, wanted);
                wanted.into_iter().filter_map(|it| subscribe(it).err()).map(error).collect()
            }
            Request::Unsubscribe(ids) => {
                let unsubscribe = |id| live.viewers.unsubscribe(viewer, id);
                ids.into_iter().filter_map(|id| unsubscribe(id).err()).map(error).collect()
            }
            Request::GetParameters(names, id) => vec![live.parameters(&names, id.as_deref())],
            Request::SetParameters(id) => {
                let why = "parameters are read-only; help: edit the configuration, and reload";
                vec![error(why.to_owned()), live.parameters(&[], id.as_deref())]
            }
            // Their values change with a reload only, which restarts the console.
            Request::SubscribeParameters(names) => vec![live.parameters(&names, None)],
            Request::UnsubscribeParameters => Vec::new(),
            Request::Call(call) => match self.call(&call) {
                Ok(()) => Vec::new(),
                Err(why) => vec![protocol::call_failure(call.service, call.id, &why)],
            },
        }
    }

    /// Passes a call to the main loop, which answers it.
    fn call(&self, call: &Call) -> Result<(), String> {
        if call.service != say::NUMBER {
            return Err(format!("service {} does not exist", call.service));
        }
        if call.encoding != "json" {
            return Err(format!("encoding: expected json, found {}", call.encoding));
        }
        let words = say::read(&call.request)?;
        if self.role != Role::Operator {
            let help = "help: add role=operator to the address";
            return Err(format!("a viewer may not speak to the robot; {help}"));
        }
        let ask = || self.app.hub.ask(self.viewer, call.id.into(), Verb::Say(words.clone()));
        if ask().is_ok() {
            return Ok(());
        }
        match self.app.hub.take_control(self.viewer, clock::now())? {
            Some(Answer::Control { granted: true, .. }) => ask(),
            _ => {
                let what = "another viewer is in control, which is requested for this one";
                Err(format!("{what}; help: call again once it is granted"))
            }
        }
    }
}
