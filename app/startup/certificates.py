"""An authority of one's own for the local network, and the certificate it gives the app.

Phones give position and offline pages to secure addresses only. The authority is made once and may
vouch for private addresses alone (RFC 5280, 4.2.1.10): whoever stole its key could not pretend to
be anything on the internet. No Streamlit in here.
"""

from __future__ import annotations

import ipaddress
import os
import socket
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from pathlib import Path

    from cryptography import x509
    from cryptography.hazmat.primitives.asymmetric.ec import EllipticCurvePrivateKey

    IP = ipaddress.IPv4Address | ipaddress.IPv6Address
    Issuer = tuple[EllipticCurvePrivateKey, x509.Certificate]

_YEARS_5, _DAYS_397 = timedelta(days=5 * 365), timedelta(days=397)
_SOON = timedelta(days=30)
_PRIVATE = (
    *("10.0.0.0/8", "172.16.0.0/12", "192.168.0.0/16", "169.254.0.0/16", "127.0.0.0/8"),
    *("fc00::/7", "fe80::/10", "::1/128"),
)
_NAMES = ("local", "lan", "localhost", "home.arpa")


@dataclass(frozen=True)
class Certificates:
    """Files of the app's certificate.

    Parameters
    ----------
    authority
        Certificate (DER) that phones are to trust.
    chain, key
        Certificate of the app (PEM), and its key.
    fingerprint
        SHA-256 of the authority's certificate, as phones show it.
    """

    authority: bytes
    chain: Path
    key: Path
    fingerprint: str


def local_address() -> str:
    """Return this machine's address on the local network; raise `SettingError` if it is on none."""
    found = [
        address
        for family, away in ((socket.AF_INET, "10.255.255.255"), (socket.AF_INET6, "fd00::1"))
        if (address := _way_to(family, away)) and not ipaddress.ip_address(address).is_loopback
    ]
    if not found:
        raise SettingError(
            "This machine must be on a local network for --lan, but it is on none. Connect it, or "
            "say its address with --address."
        )
    return next((one for one in found if _is_private(ipaddress.ip_address(one))), found[0])


def _way_to(family: socket.AddressFamily, away: str) -> str:
    """Return from which address this machine would send there; empty: it could not."""
    try:
        with socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.connect((away, 1))  # nothing is sent: it says which way it would go
            return str(probe.getsockname()[0])
    except OSError:
        return ""


def _ip(address: str) -> IP:
    """Return an address as a number; raise `SettingError` for a name."""
    try:
        return ipaddress.ip_address(address)
    except ValueError as error:
        raise SettingError(
            f"An address for --lan must be a number, as 192.168.1.5, but it is {address}. Say with "
            "--address by which number phones reach this machine."
        ) from error


def _is_private(ip: IP) -> bool:
    return any(ip in ipaddress.ip_network(net) for net in _PRIVATE)


def certificates(folder: Path, address: str) -> Certificates:
    """Return certificates for an address; what is kept in the folder is used while it holds.

    Raise `SettingError` if the address is no number, or not private.
    """
    from cryptography.hazmat.primitives import hashes, serialization  # noqa: PLC0415 - for --lan

    ip = _ip(address)
    if not _is_private(ip):
        raise SettingError(
            f"An address for --lan must be private, as 192.168.1.5, but it is {address}. If this "
            "machine has a private one, say it with --address; on the internet put the app behind "
            "a server with a certificate of its own (see the documentation, Serving phones)."
        )
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    authority = _kept(folder, "authority") or _made_authority(folder)
    server = _kept(folder, "app")
    if server is None or not _fits(server[1], ip, authority[1]):
        _made_server(folder, authority, ip)
    der = authority[1].public_bytes(serialization.Encoding.DER)
    mark = authority[1].fingerprint(hashes.SHA256()).hex(":").upper()
    return Certificates(der, folder / "app.crt", folder / "app.key", mark)


def _kept(folder: Path, name: str) -> Issuer | None:
    from cryptography import x509  # noqa: PLC0415
    from cryptography.hazmat.primitives import serialization  # noqa: PLC0415

    try:
        key = serialization.load_pem_private_key((folder / f"{name}.key").read_bytes(), None)
        made = x509.load_pem_x509_certificate((folder / f"{name}.crt").read_bytes())
    except (OSError, ValueError):
        return None
    lasts = made.not_valid_after_utc > datetime.now(UTC) + _SOON
    return (key, made) if lasts else None  # type: ignore[return-value]


def _fits(
    made: x509.Certificate,
    ip: IP,
    authority: x509.Certificate,
) -> bool:
    from cryptography import x509  # noqa: PLC0415

    named = made.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    try:
        made.verify_directly_issued_by(authority)
    except Exception:  # noqa: BLE001 - whatever is wrong with it, it does not fit
        return False
    return ip in named.get_values_for_type(x509.IPAddress)


def _made_authority(folder: Path) -> Issuer:
    from cryptography import x509  # noqa: PLC0415
    from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415

    key = ec.generate_private_key(ec.SECP256R1())
    name = _name(f"fieldmon on {socket.gethostname()}")
    allowed = [
        *(x509.IPAddress(ipaddress.ip_network(net)) for net in _PRIVATE),
        *(x509.DNSName(one) for one in _NAMES),
    ]
    builder = (
        _builder(name, name, key, _YEARS_5)
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_usage(signs_certificates=True), critical=True)
        .add_extension(x509.NameConstraints(allowed, None), critical=True)
    )
    return _written(folder, "authority", key, builder, key)


def _made_server(folder: Path, authority: Issuer, ip: IP) -> None:
    from cryptography import x509  # noqa: PLC0415
    from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415

    key = ec.generate_private_key(ec.SECP256R1())
    addresses = {ip, ipaddress.ip_address("127.0.0.1")}
    named = [
        x509.DNSName("localhost"),
        *(x509.IPAddress(one) for one in sorted(addresses, key=str)),
    ]
    used = x509.ExtendedKeyUsage([x509.oid.ExtendedKeyUsageOID.SERVER_AUTH])
    issuer = x509.AuthorityKeyIdentifier.from_issuer_public_key(authority[0].public_key())
    builder = (
        _builder(_name("fieldmon"), authority[1].subject, key, _DAYS_397)
        .add_extension(x509.SubjectAlternativeName(named), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_usage(signs_certificates=False), critical=True)
        .add_extension(used, critical=False)
        .add_extension(issuer, critical=False)
    )
    _written(folder, "app", key, builder, authority[0])


def _name(text: str) -> x509.Name:
    from cryptography import x509  # noqa: PLC0415

    return x509.Name([x509.NameAttribute(x509.oid.NameOID.COMMON_NAME, text[:64])])


def _builder(
    subject: x509.Name, issuer: x509.Name, key: EllipticCurvePrivateKey, lasts: timedelta
) -> x509.CertificateBuilder:
    from cryptography import x509  # noqa: PLC0415

    now = datetime.now(UTC)
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(days=1))  # a phone's clock may be behind
        .not_valid_after(now + lasts)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
    )


def _usage(*, signs_certificates: bool) -> x509.KeyUsage:
    from cryptography import x509  # noqa: PLC0415

    never = dict.fromkeys(
        ("content_commitment", "key_encipherment", "data_encipherment", "key_agreement",
         "encipher_only", "decipher_only"), False,
    )  # fmt: skip
    return x509.KeyUsage(
        digital_signature=not signs_certificates, key_cert_sign=signs_certificates,
        crl_sign=signs_certificates, **never,
    )  # fmt: skip


def _written(
    folder: Path,
    name: str,
    key: EllipticCurvePrivateKey,
    builder: x509.CertificateBuilder,
    signer: EllipticCurvePrivateKey,
) -> Issuer:
    from cryptography.hazmat.primitives import hashes, serialization  # noqa: PLC0415

    made = builder.sign(signer, hashes.SHA256())
    pem = serialization.Encoding.PEM
    secret = key.private_bytes(pem, serialization.PrivateFormat.PKCS8, serialization.NoEncryption())
    path = folder / f"{name}.key"
    path.unlink(missing_ok=True)
    # nobody else on this machine may read it, not even for a moment
    with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
        file.write(secret)
    (folder / f"{name}.crt").write_bytes(made.public_bytes(pem))
    return key, made
