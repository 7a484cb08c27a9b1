"""Proofs in the field's form, held against code that knows nothing of the verifier.

``opb`` reads problems, ``checker`` checks VeriPB's proofs against them, ``second`` makes a claim's program a
second time from the semantics, and ``comparison`` says where the two are not about the same plans.
"""
