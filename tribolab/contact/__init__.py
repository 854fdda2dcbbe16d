"""Contact mechanics of a soft flat and a rigid rough cylinder, in plane strain.

Load is force per unit length [N/m]; pressure is nominal, averaged over the roughness.
"""
