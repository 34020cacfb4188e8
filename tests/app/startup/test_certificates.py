"""Phones take the app's certificate, from an authority that vouches for nothing else."""

import ipaddress
import shutil
import ssl
import stat
import subprocess
from datetime import datetime, timedelta

import pytest
from cryptography import x509

from app.startup import certificates as made_here
from app.startup.certificates import certificates
from fieldmon.errors import SettingError


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "authority"


def read(path):
    return x509.load_pem_x509_certificate(path.read_bytes())


def test_phones_take_it_for_the_address_and_no_longer_than_they_allow(folder):
    """Apple takes none of more than 825 days, or without a purpose (support.apple.com/103769)."""
    made = certificates(folder, "192.168.1.5")
    own = read(made.chain)
    named = own.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    assert ipaddress.ip_address("192.168.1.5") in named.get_values_for_type(x509.IPAddress)
    used = own.extensions.get_extension_for_class(x509.ExtendedKeyUsage).value
    assert list(used) == [x509.oid.ExtendedKeyUsageOID.SERVER_AUTH]
    assert own.not_valid_after_utc - own.not_valid_before_utc < timedelta(days=825)
    ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(made.chain, made.key)


def test_the_authority_vouches_for_private_addresses_only(folder):
    certificates(folder, "192.168.1.5")
    authority = read(folder / "authority.crt")
    limits = authority.extensions.get_extension_for_class(x509.NameConstraints)
    assert limits.critical
    networks = [one.value for one in limits.value.permitted_subtrees
                if isinstance(one, x509.IPAddress)]  # fmt: skip
    assert all(network.is_private for network in networks)
    basic = authority.extensions.get_extension_for_class(x509.BasicConstraints).value
    assert (basic.ca, basic.path_length) == (True, 0)


@pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl is missing")
def test_another_program_finds_the_chain_whole(folder):
    made = certificates(folder, "192.168.1.5")
    asked = ["openssl", "verify", "-x509_strict", "-verify_ip", "192.168.1.5",
             "-CAfile", folder / "authority.crt", made.chain]  # fmt: skip
    assert subprocess.run(asked, capture_output=True, check=False).returncode == 0
    asked[4] = "192.168.1.6"
    assert subprocess.run(asked, capture_output=True, check=False).returncode != 0


def test_the_authority_is_made_once_and_its_keys_are_nobody_elses(folder):
    first = certificates(folder, "192.168.1.5")
    again = certificates(folder, "192.168.1.5")
    assert again.chain.read_bytes() == first.chain.read_bytes()
    before = first.key.read_bytes()
    moved = certificates(folder, "10.0.0.7")
    assert moved.fingerprint == first.fingerprint
    assert moved.key.read_bytes() != before
    for name in ("authority.key", "app.key"):
        assert stat.S_IMODE((folder / name).stat().st_mode) == 0o600


@pytest.mark.parametrize("broken", [b"", b"no key"])
def test_what_cannot_be_read_is_made_anew(folder, broken):
    first = certificates(folder, "192.168.1.5")
    (folder / "authority.key").write_bytes(broken)
    anew = certificates(folder, "192.168.1.5")
    assert anew.fingerprint != first.fingerprint
    read(anew.chain).verify_directly_issued_by(read(folder / "authority.crt"))


def test_what_ends_soon_is_made_anew(folder, monkeypatch):
    first = certificates(folder, "192.168.1.5").chain.read_bytes()

    class Later(datetime):
        @classmethod
        def now(cls, tz=None):
            return super().now(tz) + timedelta(days=380)

    monkeypatch.setattr(made_here, "datetime", Later)
    assert certificates(folder, "192.168.1.5").chain.read_bytes() != first


@pytest.mark.parametrize("address", ["8.8.8.8", "2001:4860:4860::8888"])
def test_the_internet_is_not_for_an_authority_of_ones_own(folder, address):
    with pytest.raises(SettingError, match="must be private"):
        certificates(folder, address)
    assert not folder.exists()


def test_this_machines_address_is_found_or_asked_for(monkeypatch):
    class Probe:
        def __init__(self, family, _):
            self.family = family

        def __enter__(self):
            return self

        def __exit__(self, *_):
            pass

        def connect(self, where):
            self.where = where

        def getsockname(self):
            return (found[self.family is made_here.socket.AF_INET6], 1)

    monkeypatch.setattr(made_here.socket, "socket", Probe)
    for found, own in (  # noqa: B007 - read by the probe
        (("192.168.1.5", "::1"), "192.168.1.5"),
        (("192.0.2.2", "fd00::2"), "fd00::2"),
        (("127.0.0.1", "fd00::2"), "fd00::2"),
        (("192.0.2.2", "::1"), "192.0.2.2"),
    ):
        assert made_here.local_address() == own
    found = "127.0.0.1", "::1"  # of no network
    with pytest.raises(SettingError, match="on a local network"):
        made_here.local_address()
