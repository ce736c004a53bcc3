//! The console: a page in a browser from which a person talks to the robot and sees what it thinks.
