//! Segments of shared memory, laid out and named as iceoryx2's own, with three guarantees that
//! those do not give:
//!
//! - Every page is reserved before a segment can be opened. A lack of memory is an error of its
//!   creator, with the figure, and not the death (SIGBUS) of the first process to touch the page.
//! - No segment is open to another user, and no segment of another user is used.
//! - Every open ends within its timeout, whatever has become of the file.

use super::own_files::own_files;
use super::segment_error::{self, SegmentError};
use crate::group::SHM;
use iceoryx2::prelude::SemanticString;
use iceoryx2_bb_elementary::bump_allocator::BumpAllocator;
use iceoryx2_bb_elementary::package_version::PackageVersion;
use iceoryx2_bb_elementary_traits::{
    testing::abandonable::Abandonable, zero_copy_send::ZeroCopySend,
};
use iceoryx2_bb_posix::file_descriptor::{FileDescriptorBased, FileDescriptorManagement};
use iceoryx2_bb_posix::memory_mapping::MemoryMappingCreationError as MappingError;
use iceoryx2_bb_posix::shared_memory::{
    AccessMode, CreationMode, Permission, SharedMemory, SharedMemoryBuilder,
    SharedMemoryCreationError,
};
use iceoryx2_cal::dynamic_storage::posix_shared_memory::{Configuration, Storage};
use iceoryx2_cal::dynamic_storage::{
    DynamicStorage, DynamicStorageBuilder, DynamicStorageCreateError, DynamicStorageOpenError,
    DynamicStorageOpenOrCreateError,
};
use iceoryx2_cal::named_concept::{
    FileName, NamedConcept, NamedConceptBuilder, NamedConceptConfiguration,
    NamedConceptDoesExistError, NamedConceptListError, NamedConceptMgmt,
    NamedConceptPathHintRemoveError, NamedConceptRemoveError, Path,
};
use rustix::fs::{FallocateFlags, Stat, fallocate, fstat, lstat};
use rustix::io::Errno;
use rustix::process::geteuid;
use std::fmt::{self, Debug};
use std::marker::PhantomData;
use std::mem::{MaybeUninit, size_of};
use std::os::fd::BorrowedFd;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Polling interval of a segment that its creator has not completed yet.
const LOOK_EVERY: Duration = Duration::from_millis(1);
/// Bytes of a block as the operating system counts them.
const BLOCK: u64 = 512;

/// Content types of segments.
pub(crate) trait Content: Send + Sync + Debug + ZeroCopySend {}

impl<T: Send + Sync + Debug + ZeroCopySend> Content for T {}

/// A named, mapped segment that holds a `T`.
pub(crate) struct Segment<T: Send + Sync + Debug + ZeroCopySend> {
    memory: SharedMemory,
    name: FileName,
    _content: PhantomData<T>,
}

/// Start of a segment, before the memory that the content allocates for itself.
#[repr(C)]
struct Layout<T> {
    /// Version of iceoryx2; 0 until the content is complete.
    version: AtomicU64,
    content: MaybeUninit<T>,
}

/// Short: iceoryx2 formats most of its objects for log messages that nobody reads.
impl<T: Content> Debug for Segment<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Segment")
    }
}

// SAFETY: a mapping may be used from any thread, and the content is itself `Send`.
#[allow(unsafe_code)]
unsafe impl<T: Content> Send for Segment<T> {}
// SAFETY: other processes use the content at the same time, so it is `Sync`.
#[allow(unsafe_code)]
unsafe impl<T: Content> Sync for Segment<T> {}

type Initialize<'a, T> = dyn FnMut(&mut MaybeUninit<T>, &mut BumpAllocator) -> bool + 'a;

/// Builder of a [`Segment`].
pub(crate) struct Builder<'a, T: Send + Sync + Debug + ZeroCopySend> {
    name: FileName,
    config: Configuration<T>,
    supplementary_size: usize,
    has_ownership: bool,
    timeout: Duration,
    initialize: Option<Box<Initialize<'a, T>>>,
}

impl<T: Content> Debug for Builder<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Builder").field("name", &self.name).finish_non_exhaustive()
    }
}

impl<T: Content> NamedConceptBuilder<Segment<T>> for Builder<'_, T> {
    fn new(name: &FileName) -> Self {
        Self {
            name: *name,
            config: Configuration::default(),
            supplementary_size: 0,
            has_ownership: true,
            timeout: Duration::ZERO,
            initialize: None,
        }
    }

    fn config(mut self, config: &Configuration<T>) -> Self {
        self.config = config.clone();
        self
    }
}

impl<'a, T: Content> DynamicStorageBuilder<'a, T, Segment<T>> for Builder<'a, T> {
    fn has_ownership(mut self, value: bool) -> Self {
        self.has_ownership = value;
        self
    }

    /// Ignored: the segments of a group are for its owner only.
    fn enable_global_access(self, _: bool) -> Self {
        self
    }

    fn supplementary_size(mut self, value: usize) -> Self {
        self.supplementary_size = value;
        self
    }

    fn timeout(mut self, value: Duration) -> Self {
        self.timeout = value;
        self
    }

    fn initializer<F: FnMut(&mut MaybeUninit<T>, &mut BumpAllocator) -> bool + 'a>(
        mut self,
        value: F,
    ) -> Self {
        self.initialize = Some(Box::new(value));
        self
    }

    fn create(mut self) -> Result<Segment<T>, DynamicStorageCreateError> {
        self.create_reserved()
    }

    fn open(self, access: AccessMode) -> Result<Segment<T>, DynamicStorageOpenError> {
        self.open_own(access)
    }

    fn open_or_create(mut self) -> Result<Segment<T>, DynamicStorageOpenOrCreateError> {
        let until = Instant::now() + self.timeout;
        loop {
            match self.open_own(AccessMode::ReadWrite) {
                Err(DynamicStorageOpenError::DoesNotExist) => {}
                opened => return Ok(opened?),
            }
            match self.create_reserved() {
                // Created by another process, and perhaps removed again, in between.
                Err(DynamicStorageCreateError::AlreadyExists) if Instant::now() < until => {}
                created => return Ok(created?),
            }
        }
    }
}

impl<T: Content> Builder<'_, T> {
    /// Name of the file in shared memory.
    fn file(&self) -> FileName {
        self.config.path_for(&self.name).file_name()
    }

    fn create_reserved(&mut self) -> Result<Segment<T>, DynamicStorageCreateError> {
        let memory = SharedMemoryBuilder::new(&self.file())
            .creation_mode(CreationMode::CreateExclusive)
            .size(size_of::<Layout<T>>() + self.supplementary_size)
            // Not readable, so that it is not opened before it is complete.
            .permission(Permission::OWNER_WRITE)
            .zero_memory(false)
            // Removed again by any failure below.
            .has_ownership(true)
            .create()
            .map_err(|error| match error {
                SharedMemoryCreationError::AlreadyExist => DynamicStorageCreateError::AlreadyExists,
                SharedMemoryCreationError::InsufficientPermissions => {
                    DynamicStorageCreateError::InsufficientPermissions
                }
                _ => DynamicStorageCreateError::InternalError,
            })?;
        reserve(&memory).map_err(|error| {
            segment_error::note(error);
            DynamicStorageCreateError::InternalError
        })?;
        self.complete(memory)
    }

    /// Writes the content, then lets other processes of the owner in.
    fn complete(
        &mut self,
        mut memory: SharedMemory,
    ) -> Result<Segment<T>, DynamicStorageCreateError> {
        let head = memory.base_address().cast::<Layout<T>>();
        let size = memory.size() - size_of::<Layout<T>>();
        let initialize = self.initialize.as_mut();
        let initialize = initialize.ok_or(DynamicStorageCreateError::InitializationFailed)?;
        // SAFETY: the mapping begins at a page and is at least as large as a `Layout<T>` with the
        // allocator's memory behind it; its pages are reserved, it is zeroed (a valid version), and
        // no other process can have opened it.
        #[allow(unsafe_code)]
        let (head, mut allocator) =
            unsafe { (&mut *head.as_ptr(), BumpAllocator::new(head.add(1).cast(), size)) };
        if !initialize(&mut head.content, &mut allocator) {
            return Err(DynamicStorageCreateError::InitializationFailed);
        }
        head.version.store(PackageVersion::get().to_u64(), Ordering::SeqCst);
        memory
            .set_permission(Permission::OWNER_READ_WRITE)
            .map_err(|_| DynamicStorageCreateError::InternalError)?;
        if !self.has_ownership {
            memory.release_ownership();
        }
        Ok(Segment { memory, name: self.name, _content: PhantomData })
    }

    fn open_own(&self, access: AccessMode) -> Result<Segment<T>, DynamicStorageOpenError> {
        let until = Instant::now() + self.timeout;
        loop {
            if let Some(memory) = self.open_complete(access)? {
                return Ok(Segment { memory, name: self.name, _content: PhantomData });
            }
            if Instant::now() >= until {
                segment_error::note(SegmentError::Incomplete { file: self.file().to_string() });
                return Err(DynamicStorageOpenError::InitializationNotYetFinalized);
            }
            thread::sleep(LOOK_EVERY);
        }
    }

    /// Opens the segment; `None` while its creator has not completed it.
    fn open_complete(
        &self,
        access: AccessMode,
    ) -> Result<Option<SharedMemory>, DynamicStorageOpenError> {
        use SharedMemoryCreationError::{
            DoesNotExist, InsufficientPermissions, MemoryMappingCreationError,
        };
        let file = self.file();
        let memory = match SharedMemoryBuilder::new(&file).open_existing(access) {
            Ok(memory) => memory,
            Err(DoesNotExist) => return Err(DynamicStorageOpenError::DoesNotExist),
            Err(
                InsufficientPermissions
                | MemoryMappingCreationError(MappingError::MappingSizeIsZero),
            ) => {
                let path = std::path::Path::new(SHM).join(file.to_string());
                return lstat(&path)
                    .map_or(Ok(()), |stat| check_owner(&file, &stat))
                    .map(|()| None);
            }
            Err(_) => return Err(DynamicStorageOpenError::InternalError),
        };
        let stat = stat(&memory).map_err(|_| DynamicStorageOpenError::InternalError)?;
        check_owner(&file, &stat)?;
        // The superuser may open a segment that is not readable yet.
        let is_readable = stat.st_mode & 0o400 != 0;
        if !is_readable || memory.size() < size_of::<Layout<T>>() {
            return Ok(None);
        }
        // Segments that another program created, in Python for example.
        if access == AccessMode::ReadWrite {
            reserve(&memory).map_err(|error| {
                segment_error::note(error);
                DynamicStorageOpenError::InternalError
            })?;
        }
        // SAFETY: the mapping begins at a page and is at least as large as a `Layout<T>`.
        #[allow(unsafe_code)]
        let version = unsafe { &*memory.base_address().cast::<Layout<T>>().as_ptr() };
        match PackageVersion::from_u64(version.version.load(Ordering::SeqCst)) {
            version if version.to_u64() == 0 => Ok(None),
            version if version == PackageVersion::get() => Ok(Some(memory)),
            _ => Err(DynamicStorageOpenError::VersionMismatch),
        }
    }
}

/// Fails if the file belongs to another user.
fn check_owner(file: &FileName, stat: &Stat) -> Result<(), DynamicStorageOpenError> {
    if stat.st_uid == geteuid().as_raw() {
        return Ok(());
    }
    segment_error::note(SegmentError::Foreign { file: file.to_string(), user: stat.st_uid });
    Err(DynamicStorageOpenError::InternalError)
}

fn descriptor(memory: &SharedMemory) -> BorrowedFd<'_> {
    // SAFETY: the descriptor belongs to the mapping and is open as long as it.
    #[allow(unsafe_code)]
    unsafe {
        BorrowedFd::borrow_raw(memory.file_descriptor().native_handle())
    }
}

fn stat(memory: &SharedMemory) -> rustix::io::Result<Stat> {
    fstat(descriptor(memory))
}

/// Reserves every page of a segment.
fn reserve(memory: &SharedMemory) -> Result<(), SegmentError> {
    let bytes = memory.size() as u64;
    if stat(memory).is_ok_and(|stat| stat.st_blocks as u64 * BLOCK >= bytes) {
        return Ok(());
    }
    loop {
        match fallocate(descriptor(memory), FallocateFlags::empty(), 0, bytes) {
            // Not every file system that a container mounts can reserve; there nothing is lost
            // against iceoryx2's own segments.
            Ok(()) | Err(Errno::OPNOTSUPP | Errno::NOSYS) => return Ok(()),
            Err(Errno::INTR) => {}
            Err(_) => return Err(SegmentError::room(bytes)),
        }
    }
}

impl<T: Content> Abandonable for Segment<T> {
    #[allow(unsafe_code)]
    unsafe fn abandon_in_place(this: NonNull<Self>) {
        // SAFETY: the caller promises that `this` is valid and is not used again.
        unsafe { SharedMemory::abandon_in_place(NonNull::from(&mut (*this.as_ptr()).memory)) };
    }
}

impl<T: Send + Sync + Debug + ZeroCopySend> Drop for Segment<T> {
    fn drop(&mut self) {
        if self.memory.has_ownership() {
            let head = self.memory.base_address().cast::<Layout<T>>();
            // SAFETY: a segment is only built around a complete content, and its owner drops it.
            #[allow(unsafe_code)]
            unsafe {
                (*head.as_ptr()).content.assume_init_drop();
            }
        }
    }
}

impl<T: Content> NamedConcept for Segment<T> {
    fn name(&self) -> &FileName {
        &self.name
    }
}

impl<T: Content> NamedConceptMgmt for Segment<T> {
    type Configuration = Configuration<T>;

    fn does_exist_cfg(
        name: &FileName,
        config: &Configuration<T>,
    ) -> Result<bool, NamedConceptDoesExistError> {
        Storage::does_exist_cfg(name, config)
    }

    /// Lists the owner's segments only: iceoryx2 panics on a name that only begins like a
    /// segment's, which any user can make.
    fn list_cfg(config: &Configuration<T>) -> Result<Vec<FileName>, NamedConceptListError> {
        let (prefix, suffix) = (config.get_prefix().as_bytes(), config.get_suffix().as_bytes());
        let is_named = |name: &[u8]| name.starts_with(prefix) && name.ends_with(suffix);
        let files = own_files(is_named).map_err(|_| NamedConceptListError::InternalError)?;
        Ok(files.iter().filter_map(|file| config.extract_name_from_file(file)).collect())
    }

    #[allow(unsafe_code)]
    unsafe fn remove_cfg(
        name: &FileName,
        config: &Configuration<T>,
    ) -> Result<bool, NamedConceptRemoveError> {
        // SAFETY: as the caller promises.
        unsafe { Storage::remove_cfg(name, config) }
    }

    fn remove_path_hint(path: &Path) -> Result<(), NamedConceptPathHintRemoveError> {
        Storage::<T>::remove_path_hint(path)
    }
}

impl<T: Content> DynamicStorage<T> for Segment<T> {
    type Builder<'a> = Builder<'a, T>;

    fn does_support_persistency() -> bool {
        Storage::<T>::does_support_persistency()
    }

    fn has_ownership(&self) -> bool {
        self.memory.has_ownership()
    }

    fn release_ownership(&self) {
        self.memory.release_ownership();
    }

    fn acquire_ownership(&self) {
        self.memory.acquire_ownership();
    }

    fn get(&self) -> &T {
        let head = self.memory.base_address().cast::<Layout<T>>();
        // SAFETY: a segment is only built around a complete content.
        #[allow(unsafe_code)]
        unsafe {
            (*head.as_ptr()).content.assume_init_ref()
        }
    }

    #[allow(unsafe_code)]
    unsafe fn __internal_set_type_name_in_config(config: &mut Configuration<T>, name: &str) {
        // SAFETY: as the caller promises.
        unsafe { Storage::<T>::__internal_set_type_name_in_config(config, name) }
    }
}
