//! Where the master is, and under which name the robot reaches us.

use crate::settings::Ros1;
use crate::xmlrpc::authority;
use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpListener, ToSocketAddrs, UdpSocket};

/// Port of a master that is named without one.
const MASTER_PORT: u16 = 11311;

/// The addresses that a node needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    /// URI of the master.
    pub master: String,
    /// Name or address under which other nodes reach us; by default that of the interface to the master.
    pub host: Option<String>,
}

impl Address {
    /// Returns the configured addresses, else those of the environment variables that ROS uses.
    ///
    /// # Errors
    /// No master is named.
    pub fn new(
        configured: &Ros1,
        variable: impl Fn(&str) -> Option<String>,
    ) -> Result<Self, String> {
        let variable = |name: &str| variable(name).filter(|value| !value.trim().is_empty());
        let master = configured.master.clone().or_else(|| variable("ROS_MASTER_URI"));
        let Some(master) = master else {
            return Err("expected the robot's ROS master, found neither arm.ros1.master nor \
                        $ROS_MASTER_URI; help: --set arm.ros1.master=HOST"
                .to_owned());
        };
        let host = configured.host.clone();
        let host = host.or_else(|| variable("ROS_HOSTNAME")).or_else(|| variable("ROS_IP"));
        Ok(Self { master: master_uri(master.trim()), host })
    }

    /// Returns the name under which others reach us, and the address to listen at: only that one, since
    /// nothing in ROS 1 asks who connects.
    ///
    /// # Errors
    /// The master's name or our own is not known yet, or our own is that of another machine.
    pub fn own(&self) -> io::Result<(String, IpAddr)> {
        let Some(host) = &self.host else {
            let ip = self.towards_master()?;
            return Ok((ip.to_string(), ip));
        };
        let found = resolve(&with_port(host, 0))?;
        // Not at all of them instead: whoever reaches one may command the robot.
        let ours = found.iter().find(|at| TcpListener::bind(at).is_ok());
        let at = ours.ok_or_else(|| {
            let what = format!("{host} is no address of this machine; help: correct arm.ros1.host");
            io::Error::new(io::ErrorKind::AddrNotAvailable, what)
        })?;
        Ok((host.clone(), at.ip()))
    }

    /// Our address on the way to the master. Nothing is sent for it.
    fn towards_master(&self) -> io::Result<IpAddr> {
        let mut last = io::Error::new(io::ErrorKind::NotFound, "the master has no address");
        for master in resolve(authority(&self.master))? {
            let any: IpAddr = match master {
                SocketAddr::V4(_) => Ipv4Addr::UNSPECIFIED.into(),
                SocketAddr::V6(_) => Ipv6Addr::UNSPECIFIED.into(),
            };
            let tried = UdpSocket::bind((any, 0)).and_then(|socket| {
                socket.connect(master)?;
                Ok(socket.local_addr()?.ip())
            });
            match tried {
                Ok(ip) => return Ok(ip),
                Err(error) => last = error,
            }
        }
        Err(last)
    }
}

/// Addresses of `host:port`, those of IPv4 first: most programs of ROS know no others.
fn resolve(authority: &str) -> io::Result<Vec<SocketAddr>> {
    let mut found: Vec<SocketAddr> = authority.to_socket_addrs()?.collect();
    found.sort_by_key(SocketAddr::is_ipv6);
    Ok(found)
}

/// The URI of a master that is written as a URI, as `host:port` or as a host alone.
fn master_uri(written: &str) -> String {
    let place = authority(written);
    let port = place.rsplit_once(':').map(|(_, port)| port);
    let has_port = !place.ends_with(']') && port.is_some_and(|port| port.parse::<u16>().is_ok());
    match has_port {
        true => format!("http://{place}/"),
        false => format!("http://{}/", with_port(place, MASTER_PORT)),
    }
}

/// Joins host and port; an IPv6 address goes into brackets.
pub(crate) fn with_port(host: &str, port: impl std::fmt::Display) -> String {
    match host.contains(':') && !host.starts_with('[') {
        true => format!("[{host}]:{port}"),
        false => format!("{host}:{port}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Ros1Objects;

    fn ros1(master: Option<&str>, host: Option<&str>) -> Ros1 {
        let [master, host] = [master, host].map(|text| text.map(str::to_owned));
        Ros1 { master, host, objects: Ros1Objects::default() }
    }

    #[test]
    fn master_may_be_written_as_a_host() {
        for (written, uri) in [
            ("011303P0017.local", "http://011303P0017.local:11311/"),
            ("robot:11312", "http://robot:11312/"),
            ("http://10.0.0.2:11311", "http://10.0.0.2:11311/"),
            ("http://robot.local/", "http://robot.local:11311/"),
            ("[fe80::1]", "http://[fe80::1]:11311/"),
        ] {
            assert_eq!(master_uri(written), uri);
        }
    }

    #[test]
    fn configuration_comes_before_the_environment() {
        let variable = |name: &str| Some(format!("{}.local", name.to_lowercase()));
        let own = Address::new(&ros1(Some("a"), Some("b")), variable).unwrap();
        assert_eq!((own.master.as_str(), own.host.as_deref()), ("http://a:11311/", Some("b")));
        let environment = Address::new(&ros1(None, None), variable).unwrap();
        assert_eq!(environment.master, "http://ros_master_uri.local:11311/");
        assert_eq!(environment.host.as_deref(), Some("ros_hostname.local"));
        let missing = Address::new(&ros1(None, None), |_| Some(" ".to_owned())).unwrap_err();
        assert!(missing.contains("help: --set arm.ros1.master=HOST"), "{missing}");
    }

    #[test]
    fn own_address_is_that_of_the_interface_to_the_master() {
        let own = Address { master: master_uri("127.0.0.1"), host: None }.own().unwrap();
        assert_eq!(own, ("127.0.0.1".to_owned(), Ipv4Addr::LOCALHOST.into()));
    }

    #[test]
    fn node_listens_at_no_other_address_than_the_configured_one() {
        let own = |host: &str| {
            Address { master: master_uri("127.0.0.1"), host: Some(host.to_owned()) }.own()
        };
        assert_eq!(own("127.0.0.2").unwrap().1, IpAddr::from([127, 0, 0, 2]));
        // Of the range for documentation.
        let refused = own("192.0.2.7").unwrap_err();
        assert!(refused.to_string().contains("help: correct arm.ros1.host"), "{refused}");
    }
}
