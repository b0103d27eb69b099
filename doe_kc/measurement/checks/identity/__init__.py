"""Sign and identity of every channel, input and file, told by the pattern of all slopes near rest."""
