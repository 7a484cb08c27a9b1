"""What is in a certificate, by the names of its claims."""

from serendipity.model import Certificate, Claim


def claim_of(certificate: Certificate, name: str) -> Claim:
    """The claim of a name."""
    return next(claim for claim in certificate.claims if claim.claim == name)


def verdicts(certificate: Certificate) -> dict[str, str]:
    """Verdicts by claim."""
    return {claim.claim: claim.verdict for claim in certificate.claims}
