//! The arm's side of the topics between driver and bridge.

use arm_driver::Port;
use config::Settings;
use manipulation::Robot;
use messages::robot::{Order, Report};
use service::bus::{Bus, EncodedReader, EncodedWriter, PortError};
use service::exit::Failure;

use crate::{ArmOrder, ControllerReport, ORDERS, REPORTS};

#[derive(Debug)]
struct BridgeTopics {
    orders: EncodedWriter<ArmOrder>,
    reports: EncodedReader<ControllerReport>,
}

/// Opens the topics.
pub(crate) fn connect(bus: &Bus, _: &Settings, _: &Robot) -> Result<Box<dyn Port>, Failure> {
    let (orders, reports) = (bus.encoded_writer(&ORDERS)?, bus.encoded_reader(&REPORTS)?);
    Ok(Box::new(BridgeTopics { orders, reports }))
}

impl Port for BridgeTopics {
    fn drain(&mut self, take: &mut dyn FnMut(Report<'_>)) -> Result<(), PortError> {
        // A report is whole: the newest one has everything that an older one had.
        let newest = self.reports.latest()?;
        let bytes = newest.and_then(|report| postcard::to_stdvec(&report).ok());
        bytes.into_iter().for_each(|bytes| take(Report::Own(bytes)));
        Ok(())
    }

    fn send(&mut self, order: &Order<'_>) -> Result<(), PortError> {
        let Order::Own(bytes) = order else { return Ok(()) };
        match postcard::from_bytes(bytes) {
            Ok(order) => self.orders.send(&order),
            Err(error) => {
                tracing::error!(%error, "an order of another driver is not sent");
                Ok(())
            }
        }
    }
}
