//! What neither computes a number nor says what a record holds: folders and their files, what lies in them and where it comes from,
//! how cases are shared out and what they cost. A change here makes no other numbers and throws no record away.

pub mod archive;
pub mod checkpoint_file;
pub mod cost;
pub mod difference;
pub mod files;
pub(super) mod folder_lock;
pub mod merge;
pub mod provenance;
pub mod sealed;
pub mod shard;
pub mod store;
