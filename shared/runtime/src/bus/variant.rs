//! The variant of iceoryx2's services that a group uses: its `ipc::Service`, with segments that are
//! reserved, private and never waited for without end (see [`Segment`]). Names and layout in shared
//! memory are the same, so programs with iceoryx2's own variant take part.

use super::segment::Segment;
use iceoryx2::service::Service;
use iceoryx2::service::internal::ServiceInternal;
use iceoryx2::unique_id_generator::unique_system_id::UniqueSystemId;
use iceoryx2_bb_elementary_traits::testing::abandonable::Abandonable;
use iceoryx2_bb_elementary_traits::zero_copy_send::ZeroCopySend;
use iceoryx2_bb_lock_free::mpmc::counting_bit_set::RelocatableCountingBitSet;
use iceoryx2_cal::event::trigger::{State, unix_datagram_socket::GenericUnixDatagramSocketTrigger};
use iceoryx2_cal::resizable_shared_memory::dynamic::DynamicMemory;
use iceoryx2_cal::shared_memory::common::details::{AllocatorDetails, Memory};
use iceoryx2_cal::shm_allocator::{bump_allocator::BumpAllocator, pool_allocator::PoolAllocator};
use iceoryx2_cal::zero_copy_connection::common::details::{Connection, SharedManagementData};
use iceoryx2_cal::{arc_sync_policy, bag, hash, monitoring, reactor, serialize, static_storage};
use std::fmt::Debug;

/// Payload memory of a writer.
type Payload<A> = Memory<A, Segment<AllocatorDetails<A>>>;

type Event = GenericUnixDatagramSocketTrigger<
    RelocatableCountingBitSet,
    Segment<State<RelocatableCountingBitSet, ()>>,
>;

/// Services between the processes of a group.
#[derive(Clone, Debug)]
pub(crate) struct Ipc;

impl Service for Ipc {
    type StaticStorage = static_storage::recommended::Ipc;
    type ConfigSerializer = serialize::recommended::Recommended;
    type PersistentDynamicStorage<T: Debug + Send + Sync + ZeroCopySend + 'static> = Segment<T>;
    type Bag = bag::recommended::Recommended;
    type DynamicStorage<T: Debug + Send + Sync + ZeroCopySend + 'static> = Segment<T>;
    type ServiceNameHasher = hash::recommended::Recommended;
    type SharedMemory = Payload<PoolAllocator>;
    type ResizableSharedMemory = DynamicMemory<PoolAllocator, Payload<PoolAllocator>>;
    type Connection = Connection<Segment<SharedManagementData>>;
    type Event = Event;
    type Monitoring = monitoring::recommended::Ipc;
    type Reactor = reactor::recommended::Ipc;
    type ArcThreadSafetyPolicy<T: Send + Debug + Abandonable> =
        arc_sync_policy::single_threaded::SingleThreaded<T>;
    type BlackboardMgmt<T: Send + Sync + Debug + ZeroCopySend + 'static> = Segment<T>;
    type BlackboardPayload = Payload<BumpAllocator>;
    type UniqueId = UniqueSystemId;
}

impl ServiceInternal<Ipc> for Ipc {}
